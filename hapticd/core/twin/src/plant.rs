//! What every plant can do.

use crate::hand::Hand;
use crate::noise::Noise;
use crate::truth::Truth;
use hapticd_control::io::{Command, Observation};

/// A device's mechanics, actuators, sensors and operator.
pub trait Plant: core::fmt::Debug + Send + Sync {
    /// Writes what the sensors read now: counts, forces, currents and status.
    fn observe(&self, observation: &mut Observation, noise: &mut Noise);
    /// The true state now.
    fn truth(&self) -> Truth;
    /// Lives through one tick under `command`.
    fn advance(&mut self, command: &Command);
    /// The operator.
    fn hand_mut(&mut self) -> &mut Hand;
}
