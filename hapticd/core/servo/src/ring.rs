//! A ring of fixed-size records: one writer, any number of readers, none of whom can hold it up.
//!
//! Each slot is a seqlock. Record `n` lives in slot `n % capacity`; its sequence word is `2n + 1`
//! while it is written and `2n + 2` once it is whole. A reader copies the words between two looks
//! at the sequence word and keeps the copy only if both say `2n + 2` (H. Boehm, "Can seqlocks get
//! along with programming language memory models?", MSPC 2012). No loop waits on the other side.

use crate::sync::{fence, load, store, AtomicU64, Ordering};

/// Words in front of the slots: the head alone on its cache line.
const HEAD_WORDS: usize = 8;

/// Why a record was not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unread {
    /// It is not published yet.
    NotYet,
    /// It has been overwritten.
    Lost,
}

/// Words a ring of `capacity` records of `record_words` words takes.
#[must_use]
pub const fn ring_words(capacity: usize, record_words: usize) -> usize {
    HEAD_WORDS + capacity * (record_words + 1)
}

/// Records published so far, and the slots.
#[derive(Clone, Copy)]
struct Slots<'a> {
    head: &'a AtomicU64,
    words: &'a [AtomicU64],
    slot_words: usize,
}

impl<'a> Slots<'a> {
    fn over(words: &'a [AtomicU64], record_words: usize) -> Self {
        let (head, slots) = words.split_at(HEAD_WORDS);
        Self {
            head: &head[0],
            words: slots,
            slot_words: record_words + 1,
        }
    }

    fn capacity(&self) -> u64 {
        (self.words.len() / self.slot_words) as u64
    }

    /// Sequence word and record words of record `n`.
    fn slot(&self, n: u64) -> (&'a AtomicU64, &'a [AtomicU64]) {
        let at = (n % self.capacity()) as usize * self.slot_words;
        let slot = &self.words[at..at + self.slot_words];
        (&slot[0], &slot[1..])
    }
}

/// The writing end. A ring has one in the whole system.
pub struct RingWriter<'a> {
    slots: Slots<'a>,
    next: u64,
}

impl<'a> RingWriter<'a> {
    /// The writer of the ring in `words`, laid out by [`ring_words`].
    #[must_use]
    pub fn over(words: &'a [AtomicU64], record_words: usize) -> Self {
        let slots = Slots::over(words, record_words);
        let next = slots.head.load(Ordering::Relaxed);
        Self { slots, next }
    }

    /// Publishes the next record and returns its number. Missing words keep what the slot held.
    pub fn publish(&mut self, record: &[u64]) -> u64 {
        let n = self.next;
        let (sequence, words) = self.slots.slot(n);
        sequence.store(2 * n + 1, Ordering::Relaxed);
        // A reader that sees any word below has to see the odd sequence word in its second look:
        // this fence pairs with the reader's fence.
        fence(Ordering::Release);
        store(words, record);
        // A reader that sees the even sequence word sees every word above.
        sequence.store(2 * n + 2, Ordering::Release);
        self.next = n + 1;
        self.slots.head.store(self.next, Ordering::Release);
        n
    }
}

/// A reading end. There may be any number, in any process.
#[derive(Clone, Copy)]
pub struct RingReader<'a> {
    slots: Slots<'a>,
}

impl<'a> RingReader<'a> {
    /// A reader of the ring in `words`, laid out by [`ring_words`].
    #[must_use]
    pub fn over(words: &'a [AtomicU64], record_words: usize) -> Self {
        Self {
            slots: Slots::over(words, record_words),
        }
    }

    /// Records published so far: the newest has number `head() - 1`.
    #[must_use]
    pub fn head(&self) -> u64 {
        self.slots.head.load(Ordering::Acquire)
    }

    /// Number of the oldest record that may still be there.
    #[must_use]
    pub fn oldest(&self) -> u64 {
        self.head().saturating_sub(self.slots.capacity())
    }

    /// Words of one record.
    #[must_use]
    pub fn record_words(&self) -> usize {
        self.slots.slot_words - 1
    }

    /// Copies record `n` into `out`, whose content is unspecified after an error.
    ///
    /// # Errors
    /// [`Unread`] when the record is not whole in the ring.
    pub fn read(&self, n: u64, out: &mut [u64]) -> Result<(), Unread> {
        if n >= self.head() {
            return Err(Unread::NotYet);
        }
        let (sequence, words) = self.slots.slot(n);
        let whole = 2 * n + 2;
        if sequence.load(Ordering::Acquire) != whole {
            return Err(Unread::Lost);
        }
        load(words, out);
        fence(Ordering::Acquire);
        if sequence.load(Ordering::Relaxed) == whole {
            Ok(())
        } else {
            Err(Unread::Lost)
        }
    }

    /// Copies the newest record into `out` and returns its number; `None` when there is none, or
    /// when the writer lapped the whole ring during each of a few attempts.
    pub fn latest(&self, out: &mut [u64]) -> Option<u64> {
        const ATTEMPTS: usize = 8;
        (0..ATTEMPTS).find_map(|_| {
            let n = self.head().checked_sub(1)?;
            self.read(n, out).ok().map(|()| n)
        })
    }

    /// Appends up to `max` consecutive records from `since` on to `out`. Returns the number of the
    /// first one: it is larger than `since` by the records that were overwritten before.
    pub fn read_since(&self, since: u64, max: usize, out: &mut Vec<u64>) -> u64 {
        let mut record = vec![0; self.record_words()];
        let mut first = since.max(self.oldest());
        let mut count = 0;
        while count < max {
            match self.read(first + count as u64, &mut record) {
                Ok(()) => {
                    out.extend_from_slice(&record);
                    count += 1;
                }
                Err(Unread::Lost) if count == 0 => first = self.oldest().max(first + 1),
                Err(_) => break,
            }
        }
        first
    }
}

#[cfg(all(test, not(loom)))]
#[path = "ring_test.rs"]
mod tests;
