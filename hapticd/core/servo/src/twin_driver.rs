//! The driver of a twin: one step of the plant an exchange, in the loop's own thread.

use crate::driver::{Driver, TwinFace};
use hapticd_control::io::{Axes, Command, Exchange, Observation};
use hapticd_twin::{Injection, Script, Twin};

/// A twin as a device.
pub struct TwinDriver {
    twin: Twin,
}

impl TwinDriver {
    /// A device that is `twin`.
    #[must_use]
    pub fn new(twin: Twin) -> Self {
        Self { twin }
    }
}

impl Driver for TwinDriver {
    fn exchange(&mut self, command: &Command, observation: &mut Observation) -> Exchange {
        let (exchange, latest) = self.twin.step(command);
        if exchange == Exchange::Fresh {
            *observation = latest;
        }
        exchange
    }

    fn twin(&mut self) -> Option<&mut dyn TwinFace> {
        Some(self)
    }
}

impl TwinFace for TwinDriver {
    fn hand(&mut self, script: Script) {
        self.twin.hand(script);
    }

    fn inject(&mut self, injection: Injection) {
        self.twin.inject(injection);
    }

    fn hand_truth(&self) -> (Axes, Axes) {
        let truth = self.twin.truth();
        (truth.hand_position_m, truth.hand_force_n)
    }
}
