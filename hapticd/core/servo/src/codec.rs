//! Values as words, one after the other.

use hapticd_control::io::Axes;

/// Writes values into words.
pub struct Encoder<'a> {
    words: &'a mut [u64],
    at: usize,
}

impl<'a> Encoder<'a> {
    /// Starts at the first of `words`.
    pub fn new(words: &'a mut [u64]) -> Self {
        Self { words, at: 0 }
    }

    /// Writes one word; words past the end are dropped.
    pub fn word(&mut self, value: u64) -> &mut Self {
        if let Some(word) = self.words.get_mut(self.at) {
            *word = value;
            self.at += 1;
        }
        self
    }

    /// Writes one number.
    pub fn number(&mut self, value: f64) -> &mut Self {
        self.word(value.to_bits())
    }

    /// Writes numbers.
    pub fn numbers(&mut self, values: &[f64]) -> &mut Self {
        for value in values {
            self.number(*value);
        }
        self
    }

    /// Writes words.
    pub fn words(&mut self, values: &[u64]) -> &mut Self {
        for value in values {
            self.word(*value);
        }
        self
    }

    /// Words written.
    #[must_use]
    pub fn len(&self) -> usize {
        self.at
    }

    /// Whether nothing was written.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.at == 0
    }
}

/// Reads values from words.
pub struct Decoder<'a> {
    words: &'a [u64],
}

impl<'a> Decoder<'a> {
    /// Starts at the first of `words`.
    #[must_use]
    pub fn new(words: &'a [u64]) -> Self {
        Self { words }
    }

    /// The next word; `None` past the end.
    pub fn word(&mut self) -> Option<u64> {
        let (first, rest) = self.words.split_first()?;
        self.words = rest;
        Some(*first)
    }

    /// The next number; `None` past the end.
    pub fn number(&mut self) -> Option<f64> {
        self.word().map(f64::from_bits)
    }

    /// The next three numbers; `None` past the end.
    pub fn axes(&mut self) -> Option<Axes> {
        Some([self.number()?, self.number()?, self.number()?])
    }

    /// The next `N` words; `None` past the end.
    pub fn array<const N: usize>(&mut self) -> Option<[u64; N]> {
        let head = self.words.get(..N)?.try_into().ok()?;
        self.words = &self.words[N..];
        Some(head)
    }
}
