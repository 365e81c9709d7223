//! A queue of messages of different lengths from one sender to one receiver.
//!
//! Words go round in a ring of `capacity` words; `head` counts the words ever sent, `tail` those
//! ever taken. A message is its length and then its words. The sender moves `head` only after the
//! whole message is in place, so a sender killed in the middle leaves nothing behind.

use crate::sync::{AtomicU64, Ordering};

/// Words in front of the queue: tail and head, each alone on its cache line.
const INDEX_WORDS: usize = 16;
const HEAD_AT: usize = 8;

/// The queue has no room for the message; the receiver is slow or gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// The queue held no well-formed message; all of it was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Garbled;

/// Words a mailbox with room for `capacity` words takes.
#[must_use]
pub const fn mailbox_words(capacity: usize) -> usize {
    INDEX_WORDS + capacity
}

#[derive(Clone, Copy)]
struct Queue<'a> {
    tail: &'a AtomicU64,
    head: &'a AtomicU64,
    words: &'a [AtomicU64],
}

impl<'a> Queue<'a> {
    fn over(words: &'a [AtomicU64]) -> Self {
        let (indices, words) = words.split_at(INDEX_WORDS);
        Self {
            tail: &indices[0],
            head: &indices[HEAD_AT],
            words,
        }
    }

    fn word(&self, index: u64) -> &'a AtomicU64 {
        &self.words[(index % self.words.len() as u64) as usize]
    }
}

/// The sending end. A mailbox has one in the whole system.
pub struct Sender<'a> {
    queue: Queue<'a>,
}

impl<'a> Sender<'a> {
    /// The sender of the mailbox in `words`, laid out by [`mailbox_words`].
    #[must_use]
    pub fn over(words: &'a [AtomicU64]) -> Self {
        Self {
            queue: Queue::over(words),
        }
    }

    /// Sends one message, whole or not at all.
    ///
    /// # Errors
    /// [`Full`] when there is no room for it now.
    pub fn send(&mut self, message: &[u64]) -> Result<(), Full> {
        let head = self.queue.head.load(Ordering::Relaxed);
        // The receiver has finished reading what it passed: its words may be overwritten.
        let tail = self.queue.tail.load(Ordering::Acquire);
        let used = head.wrapping_sub(tail) as usize;
        if used.saturating_add(1 + message.len()) > self.queue.words.len() {
            return Err(Full);
        }
        let length = self.queue.word(head);
        length.store(message.len() as u64, Ordering::Relaxed);
        for (k, word) in (1..).zip(message) {
            let cell = self.queue.word(head.wrapping_add(k));
            cell.store(*word, Ordering::Relaxed);
        }
        // A receiver that sees the new head sees the message.
        let next = head.wrapping_add(1 + message.len() as u64);
        self.queue.head.store(next, Ordering::Release);
        Ok(())
    }
}

/// The receiving end. A mailbox has one in the whole system.
pub struct Receiver<'a> {
    queue: Queue<'a>,
}

impl<'a> Receiver<'a> {
    /// The receiver of the mailbox in `words`, laid out by [`mailbox_words`].
    #[must_use]
    pub fn over(words: &'a [AtomicU64]) -> Self {
        Self {
            queue: Queue::over(words),
        }
    }

    /// Takes the next message into `out` and returns its length; `None` when there is none.
    ///
    /// # Errors
    /// [`Garbled`] when the words make no message that fits `out`: the sender broke the layout.
    pub fn receive(&mut self, out: &mut [u64]) -> Result<Option<usize>, Garbled> {
        let tail = self.queue.tail.load(Ordering::Relaxed);
        let head = self.queue.head.load(Ordering::Acquire);
        if head == tail {
            return Ok(None);
        }
        let available = head.wrapping_sub(tail);
        let length = self.queue.word(tail).load(Ordering::Relaxed);
        if available > self.queue.words.len() as u64
            || length >= available
            || length > out.len() as u64
        {
            self.queue.tail.store(head, Ordering::Release);
            return Err(Garbled);
        }
        for (k, value) in (1..=length).zip(out.iter_mut()) {
            let cell = self.queue.word(tail.wrapping_add(k));
            *value = cell.load(Ordering::Relaxed);
        }
        // The words above have been read: the sender may overwrite them.
        let next = tail.wrapping_add(1 + length);
        self.queue.tail.store(next, Ordering::Release);
        Ok(Some(length as usize))
    }
}

#[cfg(all(test, not(loom)))]
#[path = "mailbox_test.rs"]
mod tests;
