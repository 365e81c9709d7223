//! The controller of one device: one call a tick, from observation to command.

use crate::bits;
use crate::bookkeeper::Bookkeeper;
use crate::check::{check, ModelError};
use crate::estimate::{Estimator, JointState};
use crate::fault::{Fault, FaultSet};
use crate::friction::FrictionState;
use crate::guard::Guard;
use crate::io::{status, Command, Exchange, Observation};
use crate::linear::V3;
use crate::model::DeviceModel;
use crate::plausibility::Reading;
use crate::publish;
use crate::record::{flag, limit, TickRecord};
use crate::render::{Renderer, Rendering};
use crate::scene::Scene;
use crate::stage::{Stage, Wanted};
use crate::state::Output;
pub use crate::state::{Event, Refusal, State};

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

/// Guard, estimator, scene and output stage of one device.
#[derive(Clone, Debug)]
pub struct Controller {
    period_s: f64,
    guard: Guard,
    estimator: Estimator,
    pose: JointState,
    renderer: Renderer,
    rendering: Rendering,
    stage: Stage,
    bookkeeper: Bookkeeper,
}

impl Controller {
    /// A controller at rest: offline, empty scene, outputs off. `rate_hz` is the tick rate.
    ///
    /// # Errors
    /// [`ModelError`] naming the key of `model` that cannot be driven at `rate_hz`.
    pub fn new(model: &DeviceModel, rate_hz: f64) -> Result<Self, ModelError> {
        check(model, rate_hz)?;
        let period_s = rate_hz.recip();
        let mut renderer = Renderer::new(model, period_s);
        let stage = Stage::new(model, period_s);
        let home = V3::from(model.joints.home_rad);
        let pose = JointState::at(&model.kinematics, home, V3::zeros());
        Ok(Self {
            period_s,
            guard: Guard::new(model, period_s),
            estimator: Estimator::new(model),
            pose,
            rendering: renderer.render(&pose, &stage.motors().residual_ohm(), None),
            renderer,
            stage,
            bookkeeper: Bookkeeper::new(model, period_s),
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
        self.guard.handle(event)
    }

    /// Marks the device as owned by a procedure, or frees it.
    pub fn set_busy(&mut self, busy: bool) {
        self.guard.set_busy(busy);
    }

    /// The state after the last tick or event.
    #[must_use]
    pub fn state(&self) -> State {
        self.guard.machine().state
    }

    /// Open interlocks against enabling, bits of [`crate::interlock`].
    #[must_use]
    pub fn interlocks(&self) -> u64 {
        self.guard.interlocks()
    }

    /// One tick: checks the observation, renders the scene, bounds the outputs and fills
    /// `record`, except for the servo's own timing, `request_id` and the twin's hand.
    /// Allocates nothing.
    pub fn tick(&mut self, input: &TickInput<'_>, record: &mut TickRecord) -> Command {
        let in_use = self.stage.sent().command.enable;
        let reading = self.guard.observe(input, in_use);
        let fresh = self.estimate(reading, input.observation);
        self.settle(fresh, input.observation);
        self.renderer.advance(self.period_s);
        if self.stage.gain() == 0.0 {
            // No force holds the hand: it may be taken through walls, and stays where it was taken.
            self.renderer.reset();
        }
        let hand_force_n = self.hand_force_n(input.observation);
        if fresh {
            let dr_ohm = self.stage.motors().residual_ohm();
            let hand = hand_force_n.as_ref();
            self.rendering = self.renderer.render(&self.pose, &dr_ohm, hand);
            self.relieve();
        }
        self.send(fresh, hand_force_n);
        self.publish(input, fresh, record);
        self.stage.sent().command
    }

    /// Takes a believed observation into the pose. Whether there was one.
    fn estimate(&mut self, reading: Reading, observation: &Observation) -> bool {
        let dt_s = match reading {
            Reading::First => {
                self.estimator.reset(&observation.counts);
                self.bookkeeper.begin();
                self.renderer.reset();
                0.0
            }
            Reading::Fresh { dt_s } => dt_s,
            Reading::Coast | Reading::Nothing | Reading::Disbelieved => return false,
        };
        self.pose = self.estimator.update(&observation.counts, dt_s);
        self.guard.judge_motion(&self.pose);
        true
    }

    /// Lets the actuator models catch up with the last command.
    fn settle(&mut self, fresh: bool, observation: &Observation) {
        let measured = fresh && observation.status & status::CURRENT_PRESENT != 0;
        let measured_a = measured.then(|| V3::from(observation.motor_current_a));
        self.stage
            .settle(&self.pose.qd, self.guard.live(), measured_a);
        self.bookkeeper
            .book(&self.stage, measured, fresh.then_some(&self.pose.q));
        if self.stage.motors().hot() {
            self.guard.raise(FaultSet::of(Fault::MotorHot));
        }
    }

    /// Lets passivity control have its say on what the walls demand.
    fn relieve(&mut self) {
        self.bookkeeper.relieve(
            self.renderer.touches(),
            &self.pose,
            &self.stage,
            &mut self.rendering.demand,
        );
    }

    fn send(&mut self, fresh: bool, hand_force_n: Option<V3>) {
        let wanted = Wanted {
            pose: &self.pose,
            demand: &self.rendering.demand,
            hand_force_n: hand_force_n.unwrap_or_default(),
            allocation: self.renderer.layers().top().allocation,
            fresh,
        };
        let sent = self
            .stage
            .send(self.guard.output(), self.guard.live(), &wanted);
        if sent.acted & limit::NON_FINITE != 0 {
            self.guard.raise(FaultSet::of(Fault::OutputNotFinite));
            self.stage.cut();
        }
        if fresh {
            self.bookkeeper.note(&self.stage);
        }
    }

    /// The measured force of the hand on the device, N; none where the sensor has a fault: then it
    /// is no value (law 4).
    fn hand_force_n(&self, observation: &Observation) -> Option<V3> {
        let faults = self.guard.machine().faults;
        let faulty = faults.contains(Fault::SensorStale) || faults.contains(Fault::SensorSaturated);
        let believed = !faulty && observation.status & status::FORCE_PRESENT != 0;
        believed.then(|| observation.force_n.into())
    }

    fn publish(&self, input: &TickInput<'_>, fresh: bool, record: &mut TickRecord) {
        let machine = self.guard.machine();
        record.tick = input.tick;
        record.t_mono_ns = input.t_mono_ns;
        record.state = machine.state as u64;
        record.faults = machine.faults.bits();
        record.flags = self.flags(fresh);
        record.scene_revision = self.renderer.layers().top().revision;
        record.observation_missing = u64::from(self.guard.plausibility().missing());
        record.observation_lost = self.guard.plausibility().lost();
        publish::observation(record, input.observation);
        publish::motion(record, &self.pose, &self.rendering);
        publish::command(record, &self.stage, &self.pose);
        publish::actuators(record, &self.stage, &self.pose);
        self.bookkeeper.publish(self.renderer.touches(), record);
    }

    fn flags(&self, fresh: bool) -> u64 {
        let machine = self.guard.machine();
        let sticks = self.rendering.friction.state == FrictionState::Stick;
        bits::union(&[
            (machine.homed, flag::HOMED),
            (machine.busy, flag::BUSY),
            (machine.estop, flag::ESTOP),
            (self.fading(), flag::FADING),
            (fresh, flag::FRESH),
            (self.rendering.contact.count > 0, flag::CONTACT),
            (sticks, flag::STICK),
            (self.bookkeeper.acts(), flag::PASSIVITY),
        ])
    }

    /// Whether a ramp, a fade or a cross-fade is running.
    fn fading(&self) -> bool {
        let moving = match self.guard.output() {
            Output::Drive => self.stage.gain() < 1.0,
            Output::Fade => self.stage.gain() > 0.0,
            Output::Cut => false,
        };
        moving || self.renderer.layers().fading()
    }
}
