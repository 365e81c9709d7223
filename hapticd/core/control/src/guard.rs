//! Watch over the device: what it says, whether that can be true, and what state follows.

use crate::controller::TickInput;
use crate::estimate::JointState;
use crate::fault::{Fault, FaultSet};
use crate::io::{status, Exchange};
use crate::model::DeviceModel;
use crate::outputs::OutputWatch;
use crate::plausibility::{Plausibility, Reading};
use crate::state::{Event, Machine, Output, Refusal, Surroundings};

/// State machine of one device with everything that feeds it.
#[derive(Clone, Debug)]
pub struct Guard {
    machine: Machine,
    around: Surroundings,
    plausibility: Plausibility,
    outputs: OutputWatch,
    late: u32,
    late_ticks: u32,
    period_s: f64,
}

impl Guard {
    /// A guard that has seen nothing: offline. Called every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            machine: Machine::default(),
            around: Surroundings::default(),
            plausibility: Plausibility::new(model, period_s),
            outputs: OutputWatch::default(),
            late: 0,
            late_ticks: model.limits.late_ticks,
            period_s,
        }
    }

    /// Carries out an event.
    ///
    /// # Errors
    /// [`Refusal`] with the open interlocks; nothing changes then.
    pub fn handle(&mut self, event: Event) -> Result<(), Refusal> {
        self.machine = self.machine.handle(event, self.around)?;
        Ok(())
    }

    /// Marks the device as owned by a procedure, or frees it.
    pub fn set_busy(&mut self, busy: bool) {
        self.machine.busy = busy;
    }

    /// The state machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Open interlocks against enabling, bits of [`crate::interlock`].
    #[must_use]
    pub fn interlocks(&self) -> u64 {
        self.machine.interlocks(self.around)
    }

    /// The judge of observations.
    #[must_use]
    pub fn plausibility(&self) -> &Plausibility {
        &self.plausibility
    }

    /// Whether the device drives its outputs.
    #[must_use]
    pub fn live(&self) -> bool {
        self.outputs.live()
    }

    /// How outputs are to be driven.
    #[must_use]
    pub fn output(&self) -> Output {
        self.machine.output()
    }

    /// Latches faults.
    pub fn raise(&mut self, faults: FaultSet) {
        self.machine = self.machine.raise(faults);
    }

    /// Takes in the start of a tick. `in_use` is the `enable` of the last command. What may be
    /// done with the observation.
    pub fn observe(&mut self, input: &TickInput<'_>, in_use: bool) -> Reading {
        self.around.front_alive = input.front_alive;
        self.around.realtime_ok = input.realtime_ok;
        let verdict = self
            .plausibility
            .judge(input.exchange, input.observation, input.t_mono_ns);
        if input.exchange == Exchange::Down {
            self.lose();
        } else if !matches!(verdict.reading, Reading::Coast | Reading::Nothing) {
            self.hear(input.observation.status, in_use);
        }
        self.raise(verdict.faults);
        let overdue = self.judge_time(input, in_use);
        self.raise(overdue);
        verdict.reading
    }

    /// Judges the motion that was estimated from an observation.
    pub fn judge_motion(&mut self, state: &JointState) {
        let faults = self.plausibility.judge_motion(state);
        self.raise(faults);
    }

    fn lose(&mut self) {
        self.machine = self.machine.lose();
        self.outputs = OutputWatch::default();
        self.around.estop_input = false;
    }

    /// A new frame: the device is there, and says how it is.
    fn hear(&mut self, bits: u64, in_use: bool) {
        self.around.estop_input = bits & status::ESTOP_INPUT != 0;
        self.machine = self.machine.connect().home(bits & status::HOMED != 0);
        if self.around.estop_input {
            self.machine = self.machine.engage_estop();
        }
        let faults = self.outputs.judge(bits, in_use, self.period_s);
        self.raise(faults);
    }

    /// Deadlines of the loop and of the front (law 5). With outputs off neither does harm.
    fn judge_time(&mut self, input: &TickInput<'_>, in_use: bool) -> FaultSet {
        let mut faults = FaultSet::default();
        self.late = if input.late {
            self.late.saturating_add(1)
        } else {
            0
        };
        if in_use && self.late >= self.late_ticks {
            faults.insert(Fault::DeadlineMissed);
        }
        if in_use && !input.front_alive {
            faults.insert(Fault::FrontLost);
        }
        faults
    }
}
