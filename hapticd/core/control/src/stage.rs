//! The output stage: from the demand of the scene to a bounded command.

use crate::actuator::Motors;
use crate::allocate::Split;
use crate::bits;
use crate::bound::{bound_motor, singularity_fade, tip_share, Bounded, Bounds};
use crate::brake::Brakes;
use crate::braking::Braking;
use crate::couple::JointDemand;
use crate::estimate::JointState;
use crate::gain::Gain;
use crate::io::Command;
use crate::linear::V3;
use crate::model::{DeviceModel, LimitModel};
use crate::record::limit;
use crate::scene::Allocation;
use crate::state::Output;

/// What is to be put out, and on what.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The last pose believed.
    pub pose: &'a JointState,
    /// What the scene demands there.
    pub demand: &'a JointDemand,
    /// Measured force of the hand on the device, N; zero without a sensor.
    pub hand_force_n: V3,
    /// Sharing between motors and brakes.
    pub allocation: Allocation,
    /// Whether pose and demand are of this tick; otherwise the last outputs go on.
    pub fresh: bool,
}

/// What went out in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sent {
    /// The command.
    pub command: Command,
    /// Joint torque asked of the motors, N·m.
    pub motor_nm: V3,
    /// Brakes that may act in the direction wanted.
    pub usable: [bool; 3],
    /// The gain it was sent with.
    pub gain: f64,
    /// Limits that acted, bits of [`limit`].
    pub acted: u64,
}

/// Actuators, gain and last command of one device.
#[derive(Clone, Debug)]
pub struct Stage {
    limits: LimitModel,
    period_s: f64,
    braking: Option<Braking>,
    motors: Motors,
    gain: Gain,
    sent: Sent,
}

impl Stage {
    /// A stage with outputs off and cold motors, used every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            limits: model.limits,
            period_s,
            braking: model
                .brakes
                .map(|brakes| Braking::new(&brakes, &model.limits, period_s)),
            motors: Motors::new(&model.drive, period_s),
            gain: Gain::default(),
            sent: Sent::default(),
        }
    }

    /// The motors, as modelled.
    #[must_use]
    pub fn motors(&self) -> &Motors {
        &self.motors
    }

    /// The brakes, as modelled.
    #[must_use]
    pub fn brakes(&self) -> Option<&Brakes> {
        self.braking.as_ref().map(Braking::brakes)
    }

    /// Ramp and fade factor.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.gain.value
    }

    /// What went out last.
    #[must_use]
    pub fn sent(&self) -> &Sent {
        &self.sent
    }

    /// Lets the actuator models catch up with the last command. `live` says whether the device
    /// drove it, `qd` how the joints moved, rad/s, `measured_a` the currents if measured.
    pub fn settle(&mut self, qd: &V3, live: bool, measured_a: Option<V3>) {
        let command = &self.sent.command;
        let driven = command.enable && live;
        self.motors.step(command, qd, driven, measured_a);
        if let Some(braking) = &mut self.braking {
            braking.step(&command.brake_torque_nm.into());
        }
    }

    /// Puts out what is wanted, within every bound.
    pub fn send(&mut self, output: Output, live: bool, wanted: &Wanted<'_>) -> &Sent {
        self.gain.advance(output, live, &self.limits, self.period_s);
        self.sent = if self.in_use(output, wanted.pose) {
            self.bounded(output, wanted)
        } else {
            Sent::default()
        };
        &self.sent
    }

    /// Takes everything back at once.
    pub fn cut(&mut self) {
        self.gain = Gain::default();
        self.sent = Sent {
            acted: self.sent.acted,
            ..Sent::default()
        };
    }

    /// Whether the amplifiers are to be on (law 2): while enabled, and after that until the
    /// outputs are withdrawn.
    fn in_use(&self, output: Output, pose: &JointState) -> bool {
        match output {
            Output::Cut => false,
            Output::Drive => true,
            Output::Fade => self.sent.command.enable && !self.withdrawn(pose),
        }
    }

    /// Whether a fade has ended and the motors' force is within one slew step of zero; at the
    /// latest one more fade time after it ended. Brakes may have to be held for longer.
    fn withdrawn(&self, pose: &JointState) -> bool {
        let present_n = pose.jacobian_inverse.tr_mul(&self.motors.torque_nm());
        let at_rest = present_n.norm() <= self.limits.tip_slew_n_per_s * self.period_s
            || self.gain.idle_s >= self.limits.fade_s;
        let holding = self.holds_brakes() && self.sent.command.brake_torque_nm != [0.0; 3];
        self.gain.value == 0.0 && at_rest && !holding
    }

    /// Whether brakes keep their torque when outputs are withdrawn.
    fn holds_brakes(&self) -> bool {
        self.braking.as_ref().is_some_and(Braking::holds_on_stop)
    }

    fn bounded(&mut self, output: Output, wanted: &Wanted<'_>) -> Sent {
        let (split, fade, shaped) = if wanted.fresh {
            self.shaped(wanted)
        } else {
            (self.last_split(), self.coast_fade(), 0)
        };
        let motor = bound_motor(&split.motor_nm, &self.bounds(wanted.pose, fade));
        let (brake_nm, braked) = if output == Output::Fade && self.holds_brakes() {
            (self.sent.command.brake_torque_nm.into(), 0)
        } else {
            self.bound_brakes(&split, fade, wanted)
        };
        Sent {
            command: self.command(&motor, &brake_nm, wanted.pose),
            motor_nm: motor.torque_nm,
            usable: split.usable,
            gain: self.gain.value,
            acted: bits::union(&[(true, motor.acted), (true, braked), (true, shaped)]),
        }
    }

    /// The demand, shared between motors and brakes; its fade; and the limits that acted.
    fn shaped(&mut self, wanted: &Wanted<'_>) -> (Split, f64, u64) {
        let near = singularity_fade(
            wanted.pose.singularity_margin,
            self.limits.singularity_margin,
        );
        // What brakes and motors share is within the tip's limit together (law 1).
        let share = tip_share(
            &wanted.demand.torque_nm,
            &wanted.pose.jacobian_inverse,
            self.limits.tip_force_n,
        );
        let acted = bits::union(&[
            (near < 1.0, limit::SINGULARITY),
            (share < 1.0, limit::TIP_FORCE),
        ]);
        (self.split(wanted, share), near * self.gain.value, acted)
    }

    fn split(&mut self, wanted: &Wanted<'_>, share: f64) -> Split {
        match &mut self.braking {
            Some(braking) => braking.split(wanted, share),
            None => Split {
                motor_nm: share * wanted.demand.torque_nm,
                ..Split::default()
            },
        }
    }

    /// The last outputs once more.
    fn last_split(&self) -> Split {
        Split {
            motor_nm: self.sent.motor_nm,
            brake_nm: self.sent.command.brake_torque_nm.into(),
            usable: self.sent.usable,
        }
    }

    /// Outputs that coast fall with the gain, and do not rise with it.
    fn coast_fade(&self) -> f64 {
        if self.gain.value < self.sent.gain {
            self.gain.value / self.sent.gain
        } else {
            1.0
        }
    }

    fn bounds<'a>(&'a self, pose: &'a JointState, fade: f64) -> Bounds<'a> {
        Bounds {
            limits: &self.limits,
            period_s: self.period_s,
            fade,
            jacobian_inverse: &pose.jacobian_inverse,
            peak_nm: self.motors.limit_nm(),
            present_nm: self.motors.torque_nm(),
            retain: self.motors.retain(),
            supply: self.motors.supply(&pose.qd),
        }
    }

    /// Brake torques, N·m, and the limits that acted on them.
    fn bound_brakes(&self, split: &Split, fade: f64, wanted: &Wanted<'_>) -> (V3, u64) {
        let before_nm = self.sent.command.brake_torque_nm.into();
        match &self.braking {
            Some(braking) => braking.bound(&(fade * split.brake_nm), &before_nm, wanted),
            None => (V3::zeros(), 0),
        }
    }

    fn command(&self, motor: &Bounded, brake_nm: &V3, pose: &JointState) -> Command {
        let mut command = Command {
            enable: true,
            brake_torque_nm: (*brake_nm).into(),
            ..Command::default()
        };
        match self.motors.supply(&pose.qd) {
            Some(supply) => command.motor_v = supply.voltage_v(&motor.torque_nm).into(),
            None => command.motor_torque_nm = motor.torque_nm.into(),
        }
        command
    }
}
