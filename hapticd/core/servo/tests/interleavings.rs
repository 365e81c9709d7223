//! Model checking of the lock-free parts: loom runs every interleaving, and every stale value the
//! memory model allows. `RUSTFLAGS="--cfg loom" cargo test -p hapticd-servo --test interleavings`
#![cfg(loom)]

use hapticd_servo::mailbox::{mailbox_words, Receiver, Sender};
use hapticd_servo::ring::{ring_words, RingReader, RingWriter, Unread};
use hapticd_servo::sync::AtomicU64;
use loom::sync::Arc;
use loom::thread;

const WORDS: usize = 2;

fn memory(words: usize) -> Arc<Vec<AtomicU64>> {
    Arc::new((0..words).map(|_| AtomicU64::new(0)).collect())
}

fn record(n: u64) -> [u64; WORDS] {
    [10 + n, 20 + n]
}

#[test]
fn a_reader_gets_a_whole_record_or_none() {
    loom::model(|| {
        // One slot: every record overwrites the one being read.
        let memory = memory(ring_words(1, WORDS));
        let shared = Arc::clone(&memory);
        let writer = thread::spawn(move || {
            let mut writer = RingWriter::over(&shared, WORDS);
            writer.publish(&record(0));
            writer.publish(&record(1));
        });
        let reader = RingReader::over(&memory, WORDS);
        let mut out = [0; WORDS];
        for n in 0..2 {
            if reader.read(n, &mut out).is_ok() {
                assert_eq!(out, record(n));
            }
        }
        writer.join().unwrap();
        assert_eq!(reader.read(0, &mut out), Err(Unread::Lost));
        assert_eq!(reader.read(1, &mut out), Ok(()));
    });
}

#[test]
fn two_readers_do_not_disturb_each_other() {
    let mut model = loom::model::Builder::new();
    // Three threads: every interleaving with at most two preemptions, within seconds.
    model.preemption_bound = Some(2);
    model.check(|| {
        let memory = memory(ring_words(1, WORDS));
        let mut writer = RingWriter::over(&memory, WORDS);
        writer.publish(&record(0));
        let read = |memory: Arc<Vec<AtomicU64>>| {
            let mut out = [0; WORDS];
            match RingReader::over(&memory, WORDS).read(0, &mut out) {
                Ok(()) => assert_eq!(out, record(0)),
                Err(why) => assert_eq!(why, Unread::Lost),
            }
        };
        let (first, second) = (Arc::clone(&memory), Arc::clone(&memory));
        let readers = [
            thread::spawn(move || read(first)),
            thread::spawn(move || read(second)),
        ];
        writer.publish(&record(1));
        for reader in readers {
            reader.join().unwrap();
        }
    });
}

#[test]
fn a_head_that_is_seen_means_that_its_record_can_be_read() {
    loom::model(|| {
        let memory = memory(ring_words(2, WORDS));
        let shared = Arc::clone(&memory);
        let writer = thread::spawn(move || {
            let mut writer = RingWriter::over(&shared, WORDS);
            writer.publish(&record(0));
            writer.publish(&record(1));
        });
        let reader = RingReader::over(&memory, WORDS);
        let mut out = [0; WORDS];
        for n in 0..reader.head() {
            assert_eq!(reader.read(n, &mut out), Ok(()));
            assert_eq!(out, record(n));
        }
        writer.join().unwrap();
    });
}

#[test]
fn messages_arrive_whole_and_in_order_while_the_queue_wraps() {
    loom::model(|| {
        // Room for one message of two words at a time, and every message wraps.
        let memory = memory(mailbox_words(4));
        let shared = Arc::clone(&memory);
        let sender = thread::spawn(move || {
            let mut sender = Sender::over(&shared);
            (0..3)
                .filter(|n| sender.send(&record(*n)).is_ok())
                .collect::<Vec<_>>()
        });
        let mut receiver = Receiver::over(&memory);
        let mut out = [0; 4];
        let mut received = Vec::new();
        let mut take = |receiver: &mut Receiver<'_>| {
            while let Some(length) = receiver.receive(&mut out).unwrap() {
                assert_eq!(length, WORDS);
                received.push(out[0] - 10);
                assert_eq!(out[..WORDS], record(out[0] - 10));
            }
        };
        take(&mut receiver);
        let sent = sender.join().unwrap();
        take(&mut receiver);
        assert_eq!(received, sent);
    });
}
