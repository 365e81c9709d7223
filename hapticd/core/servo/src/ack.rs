//! Acks: what became of a request, and at which tick.

use crate::codec::Decoder;

/// Words of one ack.
pub const ACK_WORDS: usize = 6;

/// What became of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Outcome {
    /// In force from the ack's tick on.
    Applied = 0,
    /// The device's interlocks stand against it.
    Refused = 1,
    /// Its lease has been superseded.
    StaleEpoch = 2,
    /// It held a value that makes no sense.
    Malformed = 3,
    /// The device cannot do it: only a twin has a hand and faults to inject.
    Unsupported = 4,
}

impl Outcome {
    /// Every outcome, in the order of their numbers.
    pub const ALL: [Self; 5] = [
        Self::Applied,
        Self::Refused,
        Self::StaleEpoch,
        Self::Malformed,
        Self::Unsupported,
    ];
}

/// What became of one request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ack {
    /// The request's number.
    pub id: u64,
    /// Tick from which it is in force.
    pub tick: u64,
    /// `CLOCK_MONOTONIC` of that tick, ns.
    pub t_mono_ns: u64,
    /// What became of it.
    pub outcome: Outcome,
    /// Interlocks against it, bits of [`hapticd_control::interlock::interlock`].
    pub interlocks: u64,
    /// Number of the device's state after it.
    pub state: u64,
}

impl Ack {
    /// The ack as words.
    #[must_use]
    pub fn encode(&self) -> [u64; ACK_WORDS] {
        [
            self.id,
            self.tick,
            self.t_mono_ns,
            self.outcome as u64,
            self.interlocks,
            self.state,
        ]
    }

    /// The ack in words; `None` when they hold none.
    #[must_use]
    pub fn decode(words: &[u64]) -> Option<Self> {
        let [id, tick, t_mono_ns, outcome, interlocks, state] =
            Decoder::new(words).array::<ACK_WORDS>()?;
        Some(Self {
            id,
            tick,
            t_mono_ns,
            outcome: *Outcome::ALL.get(usize::try_from(outcome).ok()?)?,
            interlocks,
            state,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_outcome_survives_its_words() {
        for outcome in Outcome::ALL {
            let ack = Ack {
                id: 1,
                tick: 2,
                t_mono_ns: 3,
                outcome,
                interlocks: 4,
                state: 5,
            };
            assert_eq!(Ack::decode(&ack.encode()), Some(ack));
        }
    }

    #[test]
    fn an_unknown_outcome_is_no_ack() {
        assert_eq!(Ack::decode(&[1, 2, 3, 5, 0, 0]), None);
        assert_eq!(Ack::decode(&[1, 2, 3, u64::MAX, 0, 0]), None);
    }
}
