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
    /// counts once outputs are live or should be. Until then they may come and go: a frame that
    /// was on its way when they were asked for anew still tells of the last time.
    pub fn judge(&mut self, bits: u64, asked: bool, dt_s: f64) -> FaultSet {
        self.live = asked && bits & status::OUTPUTS_LIVE != 0;
        self.asked_s = if asked { self.asked_s + dt_s } else { 0.0 };
        if self.live || self.asked_s > START_UP_S {
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
