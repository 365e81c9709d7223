//! Text in a fixed number of words: its length in bytes, then UTF-8, eight bytes a word.

/// Text as words; what does not fit is cut at a character boundary.
#[must_use]
pub fn encode<const N: usize>(text: &str) -> [u64; N] {
    let mut words = [0; N];
    let mut length = text.len().min((N - 1) * 8);
    while !text.is_char_boundary(length) {
        length -= 1;
    }
    words[0] = length as u64;
    for (word, chunk) in words[1..]
        .iter_mut()
        .zip(text.as_bytes()[..length].chunks(8))
    {
        let mut bytes = [0; 8];
        bytes[..chunk.len()].copy_from_slice(chunk);
        *word = u64::from_ne_bytes(bytes);
    }
    words
}

/// The text in words; bytes that are not UTF-8 become replacement characters.
#[must_use]
pub fn decode(words: &[u64]) -> String {
    let Some((length, words)) = words.split_first() else {
        return String::new();
    };
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let length = usize::try_from(*length).map_or(0, |length| length.min(bytes.len()));
    String::from_utf8_lossy(&bytes[..length]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn text_that_fits_survives(text in "\\PC{0,10}") {
            prop_assert_eq!(decode(&encode::<6>(&text)), text);
        }

        #[test]
        fn text_too_long_is_cut_between_characters(text in "\\PC{8,40}") {
            let kept = decode(&encode::<3>(&text));
            prop_assert!(text.starts_with(&kept) && kept.len() <= 16);
        }

        #[test]
        fn any_words_decode_to_some_text(words in prop::collection::vec(any::<u64>(), 0..5)) {
            prop_assert!(decode(&words).chars().count() <= 8 * words.len());
        }
    }
}
