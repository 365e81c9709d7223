//! Whether the device drives the outputs it was asked to drive.

use crate::fault::{Fault, FaultSet};
use crate::io::status;

/// Time a device may take from `enable` to live outputs, s: describe, clear faults and three
/// good commands are a few ticks; a slow link gets the rest.
const START_UP_S: f64 = 0.25;

/// Watch over the outputs of one device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutputWatch {
    asked_s: f64,
    live: bool,
}

impl OutputWatch {
    /// Whether the device drove its outputs when last heard.
    #[must_use]
    pub fn live(&self) -> bool {
        self.live
    }

    /// Judges the status bits of a new observation. `asked` is the `enable` of the command it
    /// answers. What a board latched while nothing was asked of it is its driver's to clear; it
    /// counts once outputs were live or should have been.
    pub fn judge(&mut self, bits: u64, asked: bool, dt_s: f64) -> FaultSet {
        let live = asked && bits & status::OUTPUTS_LIVE != 0;
        let died = asked && self.live && !live;
        self.asked_s = if asked && !live {
            self.asked_s + dt_s
        } else {
            0.0
        };
        self.live = live;
        if died || live || self.asked_s > START_UP_S {
            self.blame(bits)
        } else {
            FaultSet::default()
        }
    }

    /// The most telling fault; outputs that are not live are one by themselves.
    fn blame(&self, bits: u64) -> FaultSet {
        let mut faults = FaultSet::default();
        for (bit, fault) in [
            (status::AMPLIFIER_FAULT, Fault::Amplifier),
            (status::BOARD_WATCHDOG, Fault::BoardWatchdog),
        ] {
            if bits & bit != 0 {
                faults.insert(fault);
            }
        }
        if faults.is_empty() && !self.live {
            faults.insert(Fault::OutputsNotLive);
        }
        faults
    }
}
