//! Turns what changed from one tick to the next into events.

use crate::event::{Control, What};
use hapticd_control::io::Exchange;
use hapticd_control::record::{flag, TickRecord};

/// Most changes of one tick.
const CHANGES: usize = 5;

/// Time without passivity control after which it has ended, ns. It begins at most once in it, so
/// that a wall that is touched again and again cannot flood the log.
const QUIET_NS: u64 = 500_000_000;

/// What the last tick looked like.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    state: u64,
    faults: u64,
    front_alive: bool,
    device_present: bool,
    guard: Guard,
}

/// Passivity control as it was told last.
#[derive(Clone, Copy, Debug, Default)]
struct Guard {
    /// What was told last, if that it began.
    told: Option<Control>,
    told_ns: u64,
    acted_ns: u64,
}

impl Guard {
    /// What to tell of a tick.
    fn note(&mut self, record: &TickRecord) -> Option<What> {
        let now = control(record);
        if now.is_some() {
            self.acted_ns = record.t_mono_ns;
        }
        match (&mut self.told, now) {
            (Some(told), Some(now)) if told.wall == now.wall => {
                told.energy_j = now.energy_j;
                told.damping_n_s_per_m = told.damping_n_s_per_m.max(now.damping_n_s_per_m);
                None
            }
            (told, Some(now)) if told.is_none() || record.t_mono_ns - self.told_ns >= QUIET_NS => {
                self.told = Some(now);
                self.told_ns = record.t_mono_ns;
                Some(What::Passivity(now))
            }
            (Some(told), None) if record.t_mono_ns - self.acted_ns >= QUIET_NS => {
                let ended = Control {
                    acting: false,
                    ..*told
                };
                self.told = None;
                Some(What::Passivity(ended))
            }
            _ => None,
        }
    }
}

/// What passivity control does in a tick.
fn control(record: &TickRecord) -> Option<Control> {
    let acts = record.flags & flag::PASSIVITY != 0;
    let wall = record.passivity_wall;
    let place = record
        .touched_walls
        .iter()
        .position(|touched| *touched == wall);
    acts.then(|| Control {
        wall,
        acting: true,
        energy_j: place.map_or(0.0, |place| record.touched_energy_j[place]),
        damping_n_s_per_m: record.passivity_damping_n_s_per_m,
    })
}

impl Watch {
    /// The changes since the last tick, causes before effects.
    pub fn changes(
        &mut self,
        record: &TickRecord,
        exchange: Exchange,
        front_alive: bool,
    ) -> impl Iterator<Item = What> {
        let before = *self;
        let mut guard = self.guard;
        let guarded = guard.note(record);
        *self = Self {
            state: record.state,
            faults: record.faults,
            front_alive,
            device_present: before.presence_after(exchange),
            guard,
        };
        let [front, device, faults, state] = before.until(self);
        [front, device, faults, state, guarded]
            .into_iter()
            .flatten()
    }

    /// A missing frame does not yet mean that the device went, nor that it came.
    fn presence_after(&self, exchange: Exchange) -> bool {
        match exchange {
            Exchange::Fresh => true,
            Exchange::Missing => self.device_present,
            Exchange::Down => false,
        }
    }

    fn until(&self, after: &Self) -> [Option<What>; CHANGES - 1] {
        let front = What::Front {
            alive: after.front_alive,
        };
        let device = What::Device {
            present: after.device_present,
        };
        let faults = What::Faults {
            raised: after.faults & !self.faults,
            latched: after.faults,
        };
        let state = What::State {
            from: self.state,
            to: after.state,
        };
        [
            (self.front_alive != after.front_alive).then_some(front),
            (self.device_present != after.device_present).then_some(device),
            (self.faults != after.faults).then_some(faults),
            (self.state != after.state).then_some(state),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(state: u64, faults: u64) -> TickRecord {
        TickRecord {
            state,
            faults,
            ..TickRecord::default()
        }
    }

    #[test]
    fn a_tick_like_the_last_one_tells_nothing() {
        let mut watch = Watch::default();
        let tick = record(1, 2);
        assert_eq!(watch.changes(&tick, Exchange::Fresh, true).count(), 4);
        assert_eq!(watch.changes(&tick, Exchange::Fresh, true).count(), 0);
        assert_eq!(watch.changes(&tick, Exchange::Missing, true).count(), 0);
    }

    #[test]
    fn a_loss_tells_the_device_the_new_fault_and_the_state() {
        let mut watch = Watch::default();
        watch
            .changes(&record(2, 0b1), Exchange::Fresh, true)
            .for_each(drop);
        let told: Vec<_> = watch
            .changes(&record(0, 0b11), Exchange::Down, true)
            .collect();
        let expected = [
            What::Device { present: false },
            What::Faults {
                raised: 0b10,
                latched: 0b11,
            },
            What::State { from: 2, to: 0 },
        ];
        assert_eq!(told, expected);
    }

    fn controlled(t_mono_ns: u64, acts: bool, damping_n_s_per_m: f64) -> TickRecord {
        TickRecord {
            t_mono_ns,
            flags: if acts { flag::PASSIVITY } else { 0 },
            passivity_wall: 3,
            passivity_damping_n_s_per_m: damping_n_s_per_m,
            touched_walls: [1, 3, u64::MAX],
            touched_energy_j: [0.5, 0.25, 0.0],
            ..TickRecord::default()
        }
    }

    #[test]
    fn passivity_control_that_flickers_begins_once_and_ends_after_half_a_second() {
        let mut watch = Watch::default();
        let mut told = Vec::new();
        for millisecond in 0..1000_u64 {
            let acts = millisecond < 400 && millisecond % 2 == 0;
            let tick = controlled(millisecond * 1_000_000, acts, millisecond as f64);
            let changes = watch.changes(&tick, Exchange::Missing, false);
            told.extend(changes.map(|what| (millisecond, what)));
        }
        let control = |acting, damping_n_s_per_m| {
            What::Passivity(Control {
                wall: 3,
                acting,
                energy_j: 0.25,
                damping_n_s_per_m,
            })
        };
        assert_eq!(
            told,
            [(0, control(true, 0.0)), (898, control(false, 398.0))]
        );
    }
}
