//! Turns what changed from one tick to the next into events.

use crate::event::What;
use hapticd_control::io::Exchange;
use hapticd_control::record::TickRecord;

/// Most changes of one tick.
const CHANGES: usize = 4;

/// What the last tick looked like.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    state: u64,
    faults: u64,
    front_alive: bool,
    device_present: bool,
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
        *self = Self {
            state: record.state,
            faults: record.faults,
            front_alive,
            device_present: before.presence_after(exchange),
        };
        before.until(self).into_iter().flatten()
    }

    /// A missing frame does not yet mean that the device went, nor that it came.
    fn presence_after(&self, exchange: Exchange) -> bool {
        match exchange {
            Exchange::Fresh => true,
            Exchange::Missing => self.device_present,
            Exchange::Down => false,
        }
    }

    fn until(&self, after: &Self) -> [Option<What>; CHANGES] {
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
}
