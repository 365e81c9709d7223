use super::*;
use proptest::prelude::*;
use std::collections::VecDeque;

const CAPACITY: usize = 16;

fn memory() -> Vec<AtomicU64> {
    (0..mailbox_words(CAPACITY))
        .map(|_| AtomicU64::new(0))
        .collect()
}

proptest! {
    #[test]
    fn messages_arrive_whole_once_and_in_order(
        steps in prop::collection::vec(prop::option::of(prop::collection::vec(any::<u64>(), 0..20)), 0..60)
    ) {
        let memory = memory();
        let (mut sender, mut receiver) = (Sender::over(&memory), Receiver::over(&memory));
        let mut expected = VecDeque::new();
        let mut out = [0; CAPACITY];
        for step in steps {
            if let Some(message) = step {
                let used: usize = expected.iter().map(|m: &Vec<u64>| m.len() + 1).sum();
                let fits = used + message.len() < CAPACITY;
                prop_assert_eq!(sender.send(&message).is_ok(), fits);
                if fits {
                    expected.push_back(message);
                }
            } else {
                let received = receiver.receive(&mut out).unwrap();
                prop_assert_eq!(received.map(|n| out[..n].to_vec()), expected.pop_front());
            }
        }
    }

    #[test]
    fn garbage_in_the_indices_never_harms_the_receiver(
        tail in any::<u64>(), head in any::<u64>(), word in any::<u64>(), room in 0usize..8
    ) {
        let memory = memory();
        memory[0].store(tail, Ordering::Relaxed);
        memory[HEAD_AT].store(head, Ordering::Relaxed);
        for cell in &memory[INDEX_WORDS..] {
            cell.store(word, Ordering::Relaxed);
        }
        let mut receiver = Receiver::over(&memory);
        let mut out = vec![0; room];
        if receiver.receive(&mut out) == Err(Garbled) {
            prop_assert_eq!(receiver.receive(&mut out), Ok(None));
        }
    }
}

#[test]
fn a_message_that_does_not_fit_the_receiver_is_dropped_and_the_next_one_arrives() {
    let memory = memory();
    let (mut sender, mut receiver) = (Sender::over(&memory), Receiver::over(&memory));
    sender.send(&[1, 2, 3]).unwrap();
    let mut out = [0; 2];
    assert_eq!(receiver.receive(&mut out), Err(Garbled));
    sender.send(&[4, 5]).unwrap();
    assert_eq!(receiver.receive(&mut out), Ok(Some(2)));
    assert_eq!(out, [4, 5]);
}
