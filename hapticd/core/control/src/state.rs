//! The device state machine: one pure value that takes events and returns the next value.
//! It has no clock and knows nothing of outputs; it only says how they are to be driven.

use crate::bits;
use crate::fault::{Fault, FaultSet, Severity};
use crate::interlock;

/// State of a device. The number is the one of [`crate::record::TickRecord::state`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u64)]
pub enum State {
    /// No connection. Entered from anywhere when the device goes, left to `Disabled` alone.
    #[default]
    Offline = 0,
    /// Connected, outputs off. Entered by connecting, disabling, an E-stop, or the last
    /// acknowledgement of a fault.
    Disabled = 1,
    /// Outputs follow the scene. Entered from `Disabled` or `Paused` with no interlock open.
    Enabled = 2,
    /// Outputs off, to be resumed. Entered from `Enabled` alone.
    Paused = 3,
    /// A stopping fault is latched. Left to `Disabled` when all of them are acknowledged.
    Fault = 4,
}

/// What somebody asks of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Render the scene.
    Enable,
    /// Fade to zero and switch off.
    Disable,
    /// Fade to zero and wait.
    Pause,
    /// Zero in this tick, and latch.
    EstopEngage,
    /// Clear the E-stop latch.
    EstopAcknowledge,
    /// Clear these latched faults; a cause that persists latches its fault again.
    FaultAcknowledge(FaultSet),
}

/// An event that was not carried out, and the interlocks that stand against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Bits of [`crate::interlock`].
    pub interlocks: u64,
}

/// How the outputs are to be driven in a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Follow the scene; ramp up where the outputs are not there yet.
    Drive,
    /// Go to zero within the fade time.
    Fade,
    /// Zero in this tick.
    Cut,
}

/// What the machine cannot know by itself, sampled each tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    /// The front's heartbeat is fresh.
    pub front_alive: bool,
    /// The scheduling that the configuration requires was obtained.
    pub realtime_ok: bool,
    /// The E-stop input of the device is open.
    pub estop_input: bool,
}

/// State, latches and flags of one device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Machine {
    /// The state.
    pub state: State,
    /// The E-stop latch (law 8).
    pub estop: bool,
    /// The joint zero is known.
    pub homed: bool,
    /// A procedure owns the device.
    pub busy: bool,
    /// Latched faults.
    pub faults: FaultSet,
}

impl Machine {
    /// The machine after `event`.
    ///
    /// # Errors
    /// [`Refusal`] with the interlocks that stand against the event; nothing changes then.
    pub fn handle(self, event: Event, around: Surroundings) -> Result<Self, Refusal> {
        match event {
            Event::Enable => self.enable(around),
            Event::Disable => Ok(self.withdraw()),
            Event::Pause => self.pause(),
            Event::EstopEngage => Ok(self.engage_estop()),
            Event::EstopAcknowledge => self.acknowledge_estop(around),
            Event::FaultAcknowledge(faults) => Ok(self.acknowledge(faults)),
        }
    }

    /// Open interlocks against enabling, bits of [`crate::interlock`].
    #[must_use]
    pub fn interlocks(&self, around: Surroundings) -> u64 {
        bits::union(&[
            (self.state == State::Offline, interlock::OFFLINE),
            (self.estop, interlock::ESTOP_LATCHED),
            (around.estop_input, interlock::ESTOP_INPUT),
            (!self.faults.is_empty(), interlock::FAULT_LATCHED),
            (!self.homed, interlock::NOT_HOMED),
            (!around.realtime_ok, interlock::REALTIME_MISSING),
            (self.busy, interlock::BUSY),
            (!around.front_alive, interlock::FRONT_MISSING),
        ])
    }

    /// Latches faults. Those that stop take the device to `Fault`, unless it is offline.
    #[must_use]
    pub fn raise(mut self, faults: FaultSet) -> Self {
        self.faults = FaultSet::from_bits(self.faults.bits() | faults.bits());
        if self.state != State::Offline && stops(faults) {
            self.state = State::Fault;
        }
        self
    }

    /// The driver reached the device: `Offline` becomes `Disabled`, never anything livelier.
    /// Faults latched before stay latched and keep it from being enabled.
    #[must_use]
    pub fn connect(mut self) -> Self {
        if self.state == State::Offline {
            self.state = State::Disabled;
        }
        self
    }

    /// The driver lost the device, or has not reached it yet. Only a loss is a fault.
    #[must_use]
    pub fn lose(mut self) -> Self {
        if self.state != State::Offline {
            self = self.raise(FaultSet::of(Fault::DeviceLost));
        }
        self.state = State::Offline;
        self
    }

    /// Takes what the device says of its joint zero. To lose it while outputs are in use is a
    /// fault: every position is in doubt.
    #[must_use]
    pub fn home(mut self, homed: bool) -> Self {
        let in_use = matches!(self.state, State::Enabled | State::Paused);
        if in_use && !homed {
            self = self.raise(FaultSet::of(Fault::Encoder));
        }
        self.homed = homed;
        self
    }

    /// Latches the E-stop; outputs are cut until it is acknowledged (law 8).
    #[must_use]
    pub fn engage_estop(mut self) -> Self {
        self.estop = true;
        self.withdraw()
    }

    /// How outputs are to be driven (law 2).
    #[must_use]
    pub fn output(&self) -> Output {
        let stop_now = self.faults.severity() == Some(Severity::StopNow);
        if self.estop || stop_now || self.state == State::Offline {
            Output::Cut
        } else if self.state == State::Enabled {
            Output::Drive
        } else {
            Output::Fade
        }
    }

    fn enable(mut self, around: Surroundings) -> Result<Self, Refusal> {
        let interlocks = self.interlocks(around);
        if interlocks != 0 {
            return Err(Refusal { interlocks });
        }
        self.state = State::Enabled;
        Ok(self)
    }

    fn pause(mut self) -> Result<Self, Refusal> {
        if !matches!(self.state, State::Enabled | State::Paused) {
            return Err(Refusal {
                interlocks: interlock::NOT_ENABLED,
            });
        }
        self.state = State::Paused;
        Ok(self)
    }

    fn withdraw(mut self) -> Self {
        if matches!(self.state, State::Enabled | State::Paused) {
            self.state = State::Disabled;
        }
        self
    }

    fn acknowledge_estop(mut self, around: Surroundings) -> Result<Self, Refusal> {
        if around.estop_input {
            return Err(Refusal {
                interlocks: interlock::ESTOP_INPUT,
            });
        }
        self.estop = false;
        Ok(self)
    }

    fn acknowledge(mut self, faults: FaultSet) -> Self {
        self.faults = FaultSet::from_bits(self.faults.bits() & !faults.bits());
        if self.state == State::Fault && !stops(self.faults) {
            self.state = State::Disabled;
        }
        self
    }
}

/// Whether a set holds a fault that withdraws the outputs.
fn stops(faults: FaultSet) -> bool {
    matches!(
        faults.severity(),
        Some(Severity::StopNow | Severity::SoftStop)
    )
}
