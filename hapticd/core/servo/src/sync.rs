//! The atomics of the shared words: loom's when the rings are model checked, the machine's otherwise.

#[cfg(loom)]
pub use loom::sync::atomic::{fence, AtomicU64, Ordering};
#[cfg(not(loom))]
pub use std::sync::atomic::{fence, AtomicU64, Ordering};

/// Copies words out, one relaxed load each. Both slices have the same length.
pub(crate) fn load(words: &[AtomicU64], out: &mut [u64]) {
    for (word, value) in words.iter().zip(out) {
        *value = word.load(Ordering::Relaxed);
    }
}

/// Copies words in, one relaxed store each. Both slices have the same length.
pub(crate) fn store(words: &[AtomicU64], values: &[u64]) {
    for (word, value) in words.iter().zip(values) {
        word.store(*value, Ordering::Relaxed);
    }
}
