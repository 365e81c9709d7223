//! What the loop tells the front about itself: changes, losses, misses.

use crate::codec::{Decoder, Encoder};

/// Words of one event.
pub const EVENT_WORDS: usize = 8;

/// The part of a tick that took longest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TickPart {
    /// Waking up.
    Wake,
    /// The driver's exchange.
    Exchange,
    /// The control core.
    Compute,
    /// Requests, publishing, and being preempted outside the others.
    Rest,
}

/// Why a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// It was asked to.
    Requested,
    /// It had no front for too long.
    Orphaned,
}

/// Context of missed deadlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Miss {
    /// Deadlines skipped.
    pub skipped: u64,
    /// The part of the tick that took longest.
    pub part: TickPart,
    /// How late the tick woke, ns.
    pub lateness_ns: u64,
    /// Time in the driver's exchange, ns.
    pub exchange_ns: u64,
    /// Time in the control core, ns.
    pub compute_ns: u64,
}

/// Passivity control of one wall began or ended to act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Index of the wall in the newest scene.
    pub wall: u64,
    /// Whether it acts now.
    pub acting: bool,
    /// Energy the wall took from the hand in this contact, less what it gave back, J.
    pub energy_j: f64,
    /// Largest damping since it began, N·s/m.
    pub damping_n_s_per_m: f64,
}

/// Something worth telling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// The loop runs.
    Started,
    /// The device's state changed; numbers of [`hapticd_control::state::State`].
    State {
        /// Before.
        from: u64,
        /// After.
        to: u64,
    },
    /// The latched faults changed; bits of [`hapticd_control::fault::FaultSet`].
    Faults {
        /// New ones.
        raised: u64,
        /// All.
        latched: u64,
    },
    /// Deadlines were missed.
    Miss(Miss),
    /// The driver reached or lost the device.
    Device {
        /// Whether it is there.
        present: bool,
    },
    /// The front's heartbeat came or went.
    Front {
        /// Whether it beats.
        alive: bool,
    },
    /// Passivity control began or ended to act.
    Passivity(Control),
    /// The request queue held garbage and was dropped.
    Garbled,
    /// The loop ended.
    Stopped(StopReason),
}

/// An event with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoEvent {
    /// Tick it belongs to.
    pub tick: u64,
    /// `CLOCK_MONOTONIC` of that tick, ns.
    pub t_mono_ns: u64,
    /// What happened.
    pub what: What,
}

impl ServoEvent {
    /// The event as words.
    #[must_use]
    pub fn encode(&self) -> [u64; EVENT_WORDS] {
        let (kind, details) = match self.what {
            What::Started => (0, [0; 5]),
            What::State { from, to } => (1, [from, to, 0, 0, 0]),
            What::Faults { raised, latched } => (2, [raised, latched, 0, 0, 0]),
            What::Miss(miss) => (3, miss.words()),
            What::Device { present } => (4, [present.into(), 0, 0, 0, 0]),
            What::Front { alive } => (5, [alive.into(), 0, 0, 0, 0]),
            What::Garbled => (6, [0; 5]),
            What::Stopped(reason) => (7, [(reason == StopReason::Orphaned).into(), 0, 0, 0, 0]),
            What::Passivity(control) => (8, control.words()),
        };
        let mut words = [0; EVENT_WORDS];
        Encoder::new(&mut words)
            .words(&[kind, self.tick, self.t_mono_ns])
            .words(&details);
        words
    }

    /// The event in words; `None` when they hold none.
    #[must_use]
    pub fn decode(words: &[u64]) -> Option<Self> {
        let mut decoder = Decoder::new(words);
        let [kind, tick, t_mono_ns] = decoder.array()?;
        let [a, b, c, d, e] = decoder.array()?;
        let what = match kind {
            0 => What::Started,
            1 => What::State { from: a, to: b },
            2 => What::Faults {
                raised: a,
                latched: b,
            },
            3 => What::Miss(Miss::from_words([a, b, c, d, e])),
            4 => What::Device { present: a != 0 },
            5 => What::Front { alive: a != 0 },
            6 => What::Garbled,
            7 if a == 0 => What::Stopped(StopReason::Requested),
            7 => What::Stopped(StopReason::Orphaned),
            8 => What::Passivity(Control::from_words([a, b, c, d, e])),
            _ => return None,
        };
        Some(Self {
            tick,
            t_mono_ns,
            what,
        })
    }
}

impl Miss {
    fn words(&self) -> [u64; 5] {
        [
            self.skipped,
            self.part as u64,
            self.lateness_ns,
            self.exchange_ns,
            self.compute_ns,
        ]
    }

    fn from_words([skipped, part, lateness_ns, exchange_ns, compute_ns]: [u64; 5]) -> Self {
        Self {
            skipped,
            part: match part {
                0 => TickPart::Wake,
                1 => TickPart::Exchange,
                2 => TickPart::Compute,
                _ => TickPart::Rest,
            },
            lateness_ns,
            exchange_ns,
            compute_ns,
        }
    }
}

impl Control {
    fn words(&self) -> [u64; 5] {
        [
            self.wall,
            self.acting.into(),
            self.energy_j.to_bits(),
            self.damping_n_s_per_m.to_bits(),
            0,
        ]
    }

    fn from_words([wall, acting, energy_j, damping, _]: [u64; 5]) -> Self {
        Self {
            wall,
            acting: acting != 0,
            energy_j: f64::from_bits(energy_j),
            damping_n_s_per_m: f64::from_bits(damping),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_survives_its_words() {
        let miss = |part| {
            What::Miss(Miss {
                skipped: 2,
                part,
                lateness_ns: 3,
                exchange_ns: 4,
                compute_ns: 5,
            })
        };
        let all = [
            What::Started,
            What::State { from: 1, to: 2 },
            What::Faults {
                raised: 8,
                latched: 24,
            },
            miss(TickPart::Wake),
            miss(TickPart::Exchange),
            miss(TickPart::Compute),
            miss(TickPart::Rest),
            What::Device { present: true },
            What::Device { present: false },
            What::Front { alive: true },
            What::Front { alive: false },
            What::Garbled,
            What::Stopped(StopReason::Requested),
            What::Stopped(StopReason::Orphaned),
            What::Passivity(Control {
                wall: 3,
                acting: true,
                energy_j: -0.002,
                damping_n_s_per_m: 150.0,
            }),
        ];
        for what in all {
            let event = ServoEvent {
                tick: 7,
                t_mono_ns: 9,
                what,
            };
            assert_eq!(ServoEvent::decode(&event.encode()), Some(event));
        }
    }

    #[test]
    fn unknown_kinds_are_no_event() {
        assert_eq!(ServoEvent::decode(&[99, 0, 0, 0, 0, 0, 0, 0]), None);
        assert_eq!(ServoEvent::decode(&[0, 0]), None);
    }
}
