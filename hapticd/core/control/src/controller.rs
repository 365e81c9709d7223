//! The controller of one device: one call a tick, from observation to command.

use crate::actuator::Motors;
use crate::allocate::{Allocator, Load, Split};
use crate::bound::{
    bound_brake, bound_motor, singularity_fade, tip_share, Bounded, Bounds, BrakeAsk,
};
use crate::brake::Brakes;
use crate::check::{check, ModelError};
use crate::estimate::{Estimator, JointState};
use crate::fault::{Fault, FaultSet};
use crate::gain::Gain;
use crate::io::{status, Command, Exchange, Observation};
use crate::linear::V3;
use crate::model::{BrakeModel, DeviceModel, DriveModel, LimitModel};
use crate::outputs::OutputWatch;
use crate::plausibility::{Plausibility, Reading};
use crate::publish;
use crate::record::{flag, limit, TickRecord};
use crate::render::{Renderer, Rendering};
use crate::scene::Scene;
pub use crate::state::{Event, Refusal, State};
use crate::state::{Machine, Output, Surroundings};

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

/// Brakes, and the logic that shares torque with them.
#[derive(Clone, Debug)]
struct Braking {
    model: BrakeModel,
    brakes: Brakes,
    allocator: Allocator,
}

/// What went out in the last tick.
#[derive(Clone, Copy, Debug, Default)]
struct Sent {
    command: Command,
    motor: Bounded,
    split: Split,
    gain: f64,
}

/// Estimator, scene, state machine and bounding layer of one device.
#[derive(Clone, Debug)]
pub struct Controller {
    limits: LimitModel,
    drive: DriveModel,
    period_s: f64,
    machine: Machine,
    around: Surroundings,
    plausibility: Plausibility,
    outputs: OutputWatch,
    late: u32,
    estimator: Estimator,
    pose: JointState,
    renderer: Renderer,
    rendering: Rendering,
    braking: Option<Braking>,
    motors: Motors,
    gain: Gain,
    sent: Sent,
}

impl Controller {
    /// A controller at rest: offline, empty scene, outputs off. `rate_hz` is the tick rate.
    ///
    /// # Errors
    /// [`ModelError`] naming the key of `model` that cannot be driven at `rate_hz`.
    pub fn new(model: &DeviceModel, rate_hz: f64) -> Result<Self, ModelError> {
        check(model, rate_hz)?;
        let period_s = rate_hz.recip();
        let motors = Motors::new(&model.drive, period_s);
        let renderer = Renderer::new(model);
        let home = V3::from(model.joints.home_rad);
        let pose = JointState::at(&model.kinematics, home, V3::zeros());
        Ok(Self {
            limits: model.limits,
            drive: model.drive,
            period_s,
            machine: Machine::default(),
            around: Surroundings::default(),
            plausibility: Plausibility::new(model, period_s),
            outputs: OutputWatch::default(),
            late: 0,
            estimator: Estimator::new(model),
            pose,
            rendering: renderer.render(&pose, &motors.residual_ohm()),
            renderer,
            braking: model.brakes.map(|model| Braking {
                model,
                brakes: Brakes::new(&model, period_s),
                allocator: Allocator::new(&model, period_s),
            }),
            motors,
            gain: Gain::default(),
            sent: Sent::default(),
        })
    }

    /// Takes a new scene; it replaces the present one over its fade time.
    pub fn adopt(&mut self, scene: &Scene) {
        self.renderer.adopt(scene);
    }

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

    /// Open interlocks against enabling, bits of [`crate::interlock`].
    #[must_use]
    pub fn interlocks(&self) -> u64 {
        self.machine.interlocks(self.around)
    }

    /// One tick: checks the observation, renders the scene, bounds the outputs and fills
    /// `record`, except for the servo's own timing, `request_id` and the twin's hand.
    /// Allocates nothing.
    pub fn tick(&mut self, input: &TickInput<'_>, record: &mut TickRecord) -> Command {
        record.limits = 0;
        let verdict = self
            .plausibility
            .judge(input.exchange, input.observation, input.t_mono_ns);
        self.machine = self.connection(input, verdict.reading);
        self.raise(verdict.faults);
        let faults = self.surroundings(input);
        self.raise(faults);
        let fresh = self.estimate(verdict.reading, input.observation);
        self.settle(fresh, input.observation);
        let output = self.machine.output();
        self.gain
            .advance(output, self.outputs.live(), &self.limits, self.period_s);
        self.renderer.advance(self.period_s);
        if fresh {
            self.rendering = self
                .renderer
                .render(&self.pose, &self.motors.residual_ohm());
        }
        self.sent = self.send(fresh, input.observation, record);
        self.publish(input, fresh, record);
        self.sent.command
    }

    fn raise(&mut self, faults: FaultSet) {
        self.machine = self.machine.raise(faults);
    }

    /// Connection, E-stop input and joint zero, from what the driver says.
    fn connection(&mut self, input: &TickInput<'_>, reading: Reading) -> Machine {
        let bits = input.observation.status;
        self.around.front_alive = input.front_alive;
        self.around.realtime_ok = input.realtime_ok;
        if input.exchange == Exchange::Down {
            self.outputs = OutputWatch::default();
            self.around.estop_input = false;
            return self.machine.lose();
        }
        if input.exchange == Exchange::Missing || reading == Reading::Coast {
            return self.machine;
        }
        self.around.estop_input = bits & status::ESTOP_INPUT != 0;
        let machine = self.machine.connect().home(bits & status::HOMED != 0);
        if self.around.estop_input {
            machine.engage_estop()
        } else {
            machine
        }
    }

    /// Faults that do not come from the observation's values (law 5, and the outputs).
    fn surroundings(&mut self, input: &TickInput<'_>) -> FaultSet {
        let in_use = self.sent.command.enable;
        let mut faults = FaultSet::default();
        if input.exchange == Exchange::Fresh {
            let bits = input.observation.status;
            faults = self.outputs.judge(bits, in_use, self.period_s);
        }
        self.late = if input.late {
            self.late.saturating_add(1)
        } else {
            0
        };
        if in_use && self.late >= self.limits.late_ticks {
            faults.insert(Fault::DeadlineMissed);
        }
        if in_use && !input.front_alive {
            faults.insert(Fault::FrontLost);
        }
        faults
    }

    /// Takes a believed observation into the pose. Whether there was one.
    fn estimate(&mut self, reading: Reading, observation: &Observation) -> bool {
        let dt_s = match reading {
            Reading::First => {
                self.estimator.reset(&observation.counts);
                0.0
            }
            Reading::Fresh { dt_s } => dt_s,
            Reading::Coast | Reading::Absent => return false,
        };
        self.pose = self.estimator.update(&observation.counts, dt_s);
        let faults = self.plausibility.judge_motion(&self.pose);
        self.raise(faults);
        true
    }

    /// Lets the actuator models catch up with the last command.
    fn settle(&mut self, fresh: bool, observation: &Observation) {
        let command = &self.sent.command;
        let driven = command.enable && self.outputs.live();
        let measured = fresh && observation.status & status::CURRENT_PRESENT != 0;
        let measured_a = measured.then(|| V3::from(observation.motor_current_a));
        self.motors.step(command, &self.pose.qd, driven, measured_a);
        if let Some(braking) = &mut self.braking {
            braking.brakes.step(&command.brake_torque_nm.into());
        }
        if self.motors.hot() {
            let mut faults = FaultSet::default();
            faults.insert(Fault::MotorHot);
            self.raise(faults);
        }
    }

    /// What goes out in this tick.
    fn send(&mut self, fresh: bool, observation: &Observation, record: &mut TickRecord) -> Sent {
        if !self.in_use() {
            return Sent::default();
        }
        let (split, fade) = if fresh {
            let near =
                singularity_fade(self.pose.singularity_margin, self.limits.singularity_margin);
            if near < 1.0 {
                record.limits |= limit::SINGULARITY;
            }
            (self.split(observation), near * self.gain.value)
        } else {
            (self.coast(), self.coast_fade())
        };
        let motor = bound_motor(&split.motor_nm, &self.bounds(fade));
        if motor.acted & limit::NON_FINITE != 0 {
            record.limits |= limit::NON_FINITE;
            let mut faults = FaultSet::default();
            faults.insert(Fault::OutputNotFinite);
            self.raise(faults);
            self.gain = Gain::default();
            return Sent::default();
        }
        Sent {
            command: self.command(&motor, &split, fade, record),
            motor,
            split,
            gain: self.gain.value,
        }
    }

    /// Whether the amplifiers are to be on (law 2): while enabled, and after that until the
    /// fade has ended and the motors' force is within one slew step of zero, at most two fades.
    fn in_use(&self) -> bool {
        match self.machine.output() {
            Output::Cut => false,
            Output::Drive => true,
            Output::Fade => self.sent.command.enable && !self.withdrawn(),
        }
    }

    fn withdrawn(&self) -> bool {
        let present_n = self
            .pose
            .jacobian_inverse
            .tr_mul(&self.motors.torque_nm())
            .norm();
        let at_rest = present_n <= self.limits.tip_slew_n_per_s * self.period_s
            || self.gain.idle_s >= self.limits.fade_s;
        self.gain.value == 0.0 && at_rest && !self.holding()
    }

    /// Whether brakes go on holding what they held when outputs were withdrawn.
    fn holding(&self) -> bool {
        let holds = self
            .braking
            .as_ref()
            .is_some_and(|braking| !braking.model.release_on_stop);
        let held_nm = V3::from(self.sent.command.brake_torque_nm);
        holds && self.machine.output() == Output::Fade && held_nm.max() > 0.0
    }

    /// Shares the demanded torque between motors and brakes.
    fn split(&mut self, observation: &Observation) -> Split {
        let demand = &self.rendering.demand;
        let Some(braking) = &mut self.braking else {
            return Split {
                motor_nm: demand.torque_nm,
                ..Split::default()
            };
        };
        let hand_force_n = publish::measured_force_n(observation);
        // What brakes and motors share is within the tip's limit together.
        let share = tip_share(
            &demand.torque_nm,
            &self.pose.jacobian_inverse,
            self.limits.tip_force_n,
        );
        let load = Load {
            torque_nm: share * demand.torque_nm,
            force_n: share * demand.force_n,
            force_per_torque: self.pose.jacobian_inverse.transpose(),
            qd: self.pose.qd,
            hand_torque_nm: self.pose.jacobian.tr_mul(&hand_force_n),
            hand_force_n,
            brake_nm: braking.brakes.torque_nm(),
        };
        let mode = self.renderer.layers().top().allocation;
        braking.allocator.split(mode, &load)
    }

    /// The last outputs once more.
    fn coast(&self) -> Split {
        Split {
            motor_nm: self.sent.motor.torque_nm,
            brake_nm: self.sent.command.brake_torque_nm.into(),
            usable: self.sent.split.usable,
        }
    }

    /// Outputs that coast fade as the gain falls, and do not rise.
    fn coast_fade(&self) -> f64 {
        if self.gain.value < self.sent.gain {
            self.gain.value / self.sent.gain
        } else {
            1.0
        }
    }

    fn bounds(&self, fade: f64) -> Bounds<'_> {
        Bounds {
            limits: &self.limits,
            period_s: self.period_s,
            fade,
            jacobian_inverse: &self.pose.jacobian_inverse,
            peak_nm: self.motors.limit_nm(),
            present_nm: self.motors.torque_nm(),
            retain: self.motors.retention(),
            supply: self.motors.supply(&self.pose.qd),
        }
    }

    fn command(
        &self,
        motor: &Bounded,
        split: &Split,
        fade: f64,
        record: &mut TickRecord,
    ) -> Command {
        let mut command = Command {
            enable: true,
            brake_torque_nm: self.brake_nm(split, fade, record).into(),
            ..Command::default()
        };
        match (&self.drive, self.motors.supply(&self.pose.qd)) {
            (DriveModel::Spring(_), Some(supply)) => {
                command.motor_v = supply.voltage_v(&motor.torque_nm).into();
            }
            _ => command.motor_torque_nm = motor.torque_nm.into(),
        }
        command
    }

    fn brake_nm(&self, split: &Split, fade: f64, record: &mut TickRecord) -> V3 {
        let Some(braking) = &self.braking else {
            return V3::zeros();
        };
        let before_nm = V3::from(self.sent.command.brake_torque_nm);
        if self.holding() {
            return before_nm;
        }
        V3::from_fn(|i, _| {
            let ask = BrakeAsk {
                asked_nm: split.brake_nm[i],
                before_nm: before_nm[i],
                wanted_nm: self.rendering.demand.torque_nm[i],
                qd: self.pose.qd[i],
                max_nm: braking.model.torque_max_nm[i],
            };
            let bounded_nm = bound_brake(&ask, &braking.model, &self.limits, fade, self.period_s);
            if bounded_nm < fade * ask.asked_nm {
                record.limits |= limit::BRAKE;
            }
            bounded_nm
        })
    }

    fn publish(&self, input: &TickInput<'_>, fresh: bool, record: &mut TickRecord) {
        let external_nm = self
            .pose
            .jacobian
            .tr_mul(&publish::measured_force_n(input.observation));
        record.tick = input.tick;
        record.t_mono_ns = input.t_mono_ns;
        publish::observation(record, input.observation);
        publish::motion(record, &self.pose, &self.rendering);
        publish::command(record, &self.sent.command, &self.sent.motor, &self.pose);
        publish::actuators(
            record,
            &self.pose,
            &self.motors,
            self.braking.as_ref().map(|braking| &braking.brakes),
            &external_nm,
        );
        record.sensor_force_n = publish::measured_force_n(input.observation).into();
        record.observation_missing = u64::from(self.plausibility.missing());
        record.observation_lost = self.plausibility.lost();
        record.scene_revision = self.renderer.layers().top().revision;
        record.brake_usable = publish::bits(&self.sent.split.usable);
        record.gain = self.gain.value;
        record.state = self.machine.state as u64;
        record.faults = self.machine.faults.bits();
        record.flags = self.flags(fresh);
    }

    fn flags(&self, fresh: bool) -> u64 {
        publish::flags(&[
            (self.machine.homed, flag::HOMED),
            (self.machine.busy, flag::BUSY),
            (self.machine.estop, flag::ESTOP),
            (self.fading(), flag::FADING),
            (fresh, flag::FRESH),
            (self.rendering.contact.count > 0, flag::CONTACT),
        ])
    }

    /// Whether a ramp, a fade or a cross-fade is running.
    fn fading(&self) -> bool {
        let ramping = match self.machine.output() {
            Output::Drive => self.gain.value < 1.0,
            Output::Fade => self.sent.command.enable,
            Output::Cut => false,
        };
        ramping || self.renderer.layers().fading()
    }
}
