//! What the loop needs of a driver.

use hapticd_control::io::{Axes, Command, Exchange, Observation};
use hapticd_twin::{Injection, Script};

/// A device as the loop sees it. Called from the real-time thread alone: an implementation neither
/// waits longer than the tick allows nor allocates.
pub trait Driver: Send {
    /// Hands the command of the last tick to the device and takes its newest observation.
    /// `observation` keeps its content unless [`Exchange::Fresh`] is returned.
    fn exchange(&mut self, command: &Command, observation: &mut Observation) -> Exchange;

    /// The twin inside, if the device is one.
    fn twin(&mut self) -> Option<&mut dyn TwinFace> {
        None
    }
}

/// What only a twin can do.
pub trait TwinFace {
    /// Tells the operator's hand what to do.
    fn hand(&mut self, script: Script);
    /// Injects a fault of the simulated hardware.
    fn inject(&mut self, injection: Injection);
    /// Where the hand is, m, and its true force on the device, N.
    fn hand_truth(&self) -> (Axes, Axes);
}

impl<D: Driver + ?Sized> Driver for Box<D> {
    fn exchange(&mut self, command: &Command, observation: &mut Observation) -> Exchange {
        (**self).exchange(command, observation)
    }

    fn twin(&mut self) -> Option<&mut dyn TwinFace> {
        (**self).twin()
    }
}
