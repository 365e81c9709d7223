//! The status block: what the loop says about itself about ten times a second.

use crate::codec::{Decoder, Encoder};
use crate::histogram::{Histogram, HISTOGRAM_WORDS};
use crate::scheduling::{Obtained, Policy, Realtime, SelfTest, Wish};

/// Words of the status block.
pub const STATUS_WORDS: usize = 6 + 11 + 3 * HISTOGRAM_WORDS;

/// Life of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Phase {
    /// Before the first tick.
    Starting = 0,
    /// Ticking.
    Running = 1,
    /// Fading to zero.
    Stopping = 2,
    /// After the last tick.
    Stopped = 3,
}

impl Phase {
    /// The phase of a word; anything unknown counts as stopped.
    #[must_use]
    pub fn from_word(word: u64) -> Self {
        match word {
            0 => Self::Starting,
            1 => Self::Running,
            2 => Self::Stopping,
            _ => Self::Stopped,
        }
    }
}

/// Durations since the loop started.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timings {
    /// How late ticks woke.
    pub lateness: Histogram,
    /// Time in the driver's exchange.
    pub exchange: Histogram,
    /// Time in the control core.
    pub compute: Histogram,
}

/// What the loop says about itself.
#[derive(Clone, Debug)]
pub struct Status {
    /// Tick it was written in.
    pub tick: u64,
    /// `CLOCK_MONOTONIC` of that tick, ns.
    pub t_mono_ns: u64,
    /// Number of the device's [`State`](hapticd_control::state::State).
    pub state: u64,
    /// Open interlocks, bits of [`hapticd_control::interlock::interlock`].
    pub interlocks: u64,
    /// Deadlines missed since the start.
    pub missed_ticks: u64,
    /// Requests applied since the start.
    pub requests_applied: u64,
    /// Scheduling asked for.
    pub wish: Wish,
    /// Scheduling in force.
    pub obtained: Obtained,
    /// Durations.
    pub timings: Timings,
}

impl Status {
    /// The status as words.
    pub fn encode(&self, words: &mut [u64; STATUS_WORDS]) {
        let mut encoder = Encoder::new(words);
        encoder.words(&[
            self.tick,
            self.t_mono_ns,
            self.state,
            self.interlocks,
            self.missed_ticks,
            self.requests_applied,
        ]);
        encode_scheduling(&self.wish, &self.obtained, &mut encoder);
        self.timings.lateness.encode(&mut encoder);
        self.timings.exchange.encode(&mut encoder);
        self.timings.compute.encode(&mut encoder);
    }

    /// The status in words; `None` when they hold none.
    #[must_use]
    pub fn decode(words: &[u64]) -> Option<Self> {
        let mut decoder = Decoder::new(words);
        let [tick, t_mono_ns, state, interlocks, missed_ticks, requests_applied] =
            decoder.array()?;
        let (wish, obtained) = decode_scheduling(&mut decoder)?;
        Some(Self {
            tick,
            t_mono_ns,
            state,
            interlocks,
            missed_ticks,
            requests_applied,
            wish,
            obtained,
            timings: Timings {
                lateness: Histogram::decode(&mut decoder)?,
                exchange: Histogram::decode(&mut decoder)?,
                compute: Histogram::decode(&mut decoder)?,
            },
        })
    }
}

/// A CPU as a word: 0 for none.
fn cpu_word(cpu: Option<usize>) -> u64 {
    cpu.map_or(0, |cpu| cpu as u64 + 1)
}

fn cpu_of(word: u64) -> Option<usize> {
    word.checked_sub(1).map(|cpu| cpu as usize)
}

fn encode_scheduling(wish: &Wish, obtained: &Obtained, encoder: &mut Encoder<'_>) {
    encoder.words(&[
        wish.realtime as u64,
        wish.priority.into(),
        cpu_word(wish.cpu),
        obtained.policy as u64,
        obtained.priority.into(),
        cpu_word(obtained.cpu),
        obtained.memory_locked.into(),
        obtained.self_test.samples,
        obtained.self_test.median_ns,
        obtained.self_test.p99_ns,
        obtained.self_test.max_ns,
    ]);
}

fn decode_scheduling(decoder: &mut Decoder<'_>) -> Option<(Wish, Obtained)> {
    let [realtime, wish_priority, wish_cpu] = decoder.array()?;
    let [policy, priority, cpu, memory_locked] = decoder.array()?;
    let [samples, median_ns, p99_ns, max_ns] = decoder.array()?;
    let wish = Wish {
        realtime: [Realtime::Off, Realtime::Preferred, Realtime::Required]
            .into_iter()
            .find(|choice| *choice as u64 == realtime)?,
        priority: wish_priority as u8,
        cpu: cpu_of(wish_cpu),
    };
    let obtained = Obtained {
        policy: [Policy::Other, Policy::Fifo, Policy::RoundRobin]
            .into_iter()
            .find(|choice| *choice as u64 == policy)?,
        priority: priority as u8,
        cpu: cpu_of(cpu),
        memory_locked: memory_locked != 0,
        self_test: SelfTest {
            samples,
            median_ns,
            p99_ns,
            max_ns,
        },
    };
    Some((wish, obtained))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_survives_its_words() {
        let mut timings = Timings::default();
        timings.exchange.record(1234);
        let status = Status {
            tick: 1,
            t_mono_ns: 2,
            state: 3,
            interlocks: 4,
            missed_ticks: 5,
            requests_applied: 6,
            wish: Wish {
                realtime: Realtime::Required,
                priority: 80,
                cpu: Some(0),
            },
            obtained: Obtained {
                policy: Policy::Fifo,
                priority: 79,
                cpu: None,
                memory_locked: true,
                self_test: SelfTest {
                    samples: 7,
                    median_ns: 8,
                    p99_ns: 9,
                    max_ns: 10,
                },
            },
            timings,
        };
        let mut words = [0; STATUS_WORDS];
        status.encode(&mut words);
        let decoded = Status::decode(&words).unwrap();
        assert_eq!(format!("{decoded:?}"), format!("{status:?}"));
    }

    #[test]
    fn too_few_words_are_no_status() {
        assert!(Status::decode(&[0; STATUS_WORDS - 1]).is_none());
    }
}
