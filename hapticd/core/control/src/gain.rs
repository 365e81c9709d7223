//! The ramp into `enabled` and the fade out of it.

use crate::model::LimitModel;
use crate::state::Output;

/// Factor g on every output, 0 to 1, continuous but for [`Output::Cut`] (laws 2 and 3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gain {
    /// g.
    pub value: f64,
    /// Time since g fell to zero, s.
    pub idle_s: f64,
}

impl Gain {
    /// One tick of `dt_s`. `live` says whether the device drives its outputs: the ramp waits for
    /// it, so that a slow enable sequence does not end in a step.
    pub fn advance(&mut self, output: Output, live: bool, limits: &LimitModel, dt_s: f64) {
        self.value = match output {
            Output::Drive if live => (self.value + dt_s / limits.ramp_s).min(1.0),
            Output::Fade => (self.value - dt_s / limits.fade_s).max(0.0),
            Output::Drive | Output::Cut => 0.0,
        };
        self.idle_s = if self.value > 0.0 {
            0.0
        } else {
            self.idle_s + dt_s
        };
    }
}
