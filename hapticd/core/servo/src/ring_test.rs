use super::*;
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const WORDS: usize = 3;

fn memory(capacity: usize) -> Vec<AtomicU64> {
    (0..ring_words(capacity, WORDS))
        .map(|_| AtomicU64::new(0))
        .collect()
}

fn record(n: u64) -> [u64; WORDS] {
    [n, n ^ u64::MAX, n.wrapping_mul(0x9E37_79B9_7F4A_7C15)]
}

#[test]
fn an_empty_ring_has_nothing_to_read() {
    let memory = memory(4);
    let reader = RingReader::over(&memory, WORDS);
    let mut out = [0; WORDS];
    assert_eq!(reader.latest(&mut out), None);
    assert_eq!(reader.read(0, &mut out), Err(Unread::NotYet));
    assert_eq!(reader.read_since(0, 10, &mut Vec::new()), 0);
}

#[test]
fn a_writer_that_attaches_again_continues_the_numbers() {
    let memory = memory(4);
    RingWriter::over(&memory, WORDS).publish(&record(0));
    assert_eq!(RingWriter::over(&memory, WORDS).publish(&record(1)), 1);
}

#[test]
fn a_half_written_record_is_not_read() {
    let memory = memory(4);
    let mut writer = RingWriter::over(&memory, WORDS);
    for n in 0..5 {
        writer.publish(&record(n));
    }
    let (sequence, words) = writer.slots.slot(5);
    sequence.store(2 * 5 + 1, Ordering::Relaxed);
    words[0].store(5, Ordering::Relaxed);
    let reader = RingReader::over(&memory, WORDS);
    let mut out = [0; WORDS];
    assert_eq!(reader.read(1, &mut out), Err(Unread::Lost));
    assert_eq!(reader.read(5, &mut out), Err(Unread::NotYet));
    assert_eq!(reader.latest(&mut out), Some(4));
}

proptest! {
    #[test]
    fn reading_returns_what_was_written_or_says_how_much_was_lost(
        capacity in 1usize..9, written in 0u64..40, since in 0u64..45, max in 0usize..45
    ) {
        let memory = memory(capacity);
        let mut writer = RingWriter::over(&memory, WORDS);
        for n in 0..written {
            writer.publish(&record(n));
        }
        let mut out = Vec::new();
        let first = RingReader::over(&memory, WORDS).read_since(since, max, &mut out);
        let oldest = written.saturating_sub(capacity as u64);
        prop_assert_eq!(first, since.max(oldest));
        let expected: Vec<u64> = (first..written).take(max).flat_map(record).collect();
        prop_assert_eq!(out, expected);
    }
}

#[test]
fn no_reader_ever_sees_a_torn_record_while_a_thread_writes() {
    let memory = memory(3);
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut writer = RingWriter::over(&memory, WORDS);
            let end = Instant::now() + Duration::from_millis(300);
            let mut n = 0;
            while Instant::now() < end {
                writer.publish(&record(n));
                n += 1;
            }
            done.store(true, std::sync::atomic::Ordering::Release);
        });
        let reader = RingReader::over(&memory, WORDS);
        let mut out = [0; WORDS];
        let mut seen = 0u64;
        while !done.load(std::sync::atomic::Ordering::Acquire) || seen == 0 {
            if let Some(n) = reader.latest(&mut out) {
                assert_eq!(out, record(n));
                seen += 1;
            }
        }
    });
}
