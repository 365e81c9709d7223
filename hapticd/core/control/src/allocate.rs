//! The split of a joint torque between motor and brake: brake-direction logic (physics §5).

use crate::linear::V3;
use crate::model::BrakeModel;
use crate::release::Decay;
use crate::scene::Allocation;

/// Time over which a motor leaves its share to a brake that sticks, s (physics §5: 10–20 ms).
const HAND_OVER_S: f64 = 0.015;
/// cos of the largest angle between the force wanted and the one a lone brake gives, 45°
/// (physics §5, Cho's approximation).
const LONE_BRAKE_COS: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// What is wanted of the joints, and what they meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// τ_d = JᵀF_d, N·m: what motors and brakes share.
    pub torque_nm: V3,
    /// F_d, N.
    pub force_n: V3,
    /// Torque that brakes alone may add, N·m.
    pub hold_nm: V3,
    /// Torque for the motors alone, N·m.
    pub motor_only_nm: V3,
    /// J⁻ᵀ, 1/m: its columns are the tip forces of unit joint torques.
    pub force_per_torque: nalgebra::Matrix3<f64>,
    /// q̇, rad/s.
    pub qd: V3,
    /// Jᵀ F_hand, N·m; zero without a force sensor.
    pub hand_torque_nm: V3,
    /// F_hand, N; zero without a force sensor.
    pub hand_force_n: V3,
    /// ĉ, N·m: what the brakes have built up.
    pub brake_nm: V3,
}

/// Shares of motor and brake.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Split {
    /// Joint torque for the motors, N·m.
    pub motor_nm: V3,
    /// Joint torque for the brakes, N·m, not negative.
    pub brake_nm: V3,
    /// Which brakes may act in the direction wanted.
    pub usable: [bool; 3],
}

/// Whether a brake may take part of `torque_nm`: when moving, if that dissipates; at rest, if the
/// hand pushes against it (Karnopp); between the two thresholds as decided before.
#[must_use]
pub fn usable(model: &BrakeModel, before: bool, torque_nm: f64, qd: f64, hand_nm: f64) -> bool {
    if qd.abs() > model.omega_on_rad_per_s {
        torque_nm * qd < 0.0
    } else if qd.abs() < model.omega_off_rad_per_s {
        torque_nm * hand_nm < 0.0 && hand_nm.abs() > model.hand_torque_min_nm
    } else {
        before
    }
}

/// Whether the brakes have to let go together: the joints give in to the force wanted, or rest
/// while the hand no longer pushes against it (physics §5, after KS Fig. 5).
#[must_use]
pub fn releasing(model: &BrakeModel, load: &Load) -> bool {
    if load.qd.amax() > model.omega_on_rad_per_s {
        load.torque_nm.dot(&load.qd) > 0.0
    } else if load.qd.amax() < model.omega_off_rad_per_s {
        load.force_n.dot(&load.hand_force_n) >= 0.0
    } else {
        false
    }
}

/// Whether brakes that hold have to let go together: the joints give in to them. At rest whoever
/// asked for the hold has seen to that.
#[must_use]
pub fn letting_go(model: &BrakeModel, load: &Load) -> bool {
    load.qd.amax() > model.omega_on_rad_per_s && load.hold_nm.dot(&load.qd) > 0.0
}

/// Whether a brake may hold with `hold_nm`: when moving, if that dissipates; at rest, unless the
/// hand and all that acts on the joint beside the brake, `other_nm`, push the same way: what it
/// would hold is then not what it is to hold. Where nothing acts it is charged for what comes.
#[must_use]
pub fn may_hold(model: &BrakeModel, before: bool, hold: &Holding) -> bool {
    let least_nm = model.hand_torque_min_nm;
    if hold.hold_nm == 0.0 {
        false
    } else if hold.qd.abs() < model.omega_off_rad_per_s {
        let against = hold.hold_nm.signum();
        against * hold.hand_nm < -least_nm || against * hold.other_nm <= least_nm
    } else {
        usable(model, before, hold.hold_nm, hold.qd, hold.hand_nm)
    }
}

/// A brake that is to hold one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Holding {
    /// Torque it is to hold with, N·m.
    pub hold_nm: f64,
    /// q̇, rad/s.
    pub qd: f64,
    /// Torque of the hand, N·m.
    pub hand_nm: f64,
    /// Torque of hand and motors, N·m.
    pub other_nm: f64,
}

/// Torque of the brake on `joint` when it is the only one: F_d projected on the force it gives,
/// or nothing where that points elsewhere.
#[must_use]
pub fn lone_brake_nm(load: &Load, joint: usize) -> f64 {
    let unit = load.force_per_torque.column(joint);
    let along = load.force_n.dot(&unit);
    let cos = along.abs() / (load.force_n.norm() * unit.norm());
    if cos >= LONE_BRAKE_COS && along * load.torque_nm[joint] > 0.0 {
        along.abs() / unit.norm_squared()
    } else {
        0.0
    }
}

/// The allocation of one device, with its memory.
#[derive(Clone, Copy, Debug)]
pub struct Allocator {
    model: BrakeModel,
    hand_over: f64,
    /// Brakes that may take part of the shared torque.
    usable: [bool; 3],
    /// Brakes that may hold.
    holding: [bool; 3],
    /// What the motors gave of the shared torque, N·m.
    motor_nm: V3,
}

impl Allocator {
    /// An allocator that has decided nothing yet, called every `period_s`.
    #[must_use]
    pub fn new(model: &BrakeModel, period_s: f64) -> Self {
        Self {
            model: *model,
            hand_over: 1.0 - (-period_s / HAND_OVER_S).exp(),
            usable: [false; 3],
            holding: [false; 3],
            motor_nm: V3::zeros(),
        }
    }

    /// Splits `load` in the given mode. What only motors give is theirs in every mode.
    pub fn split(&mut self, mode: Allocation, load: &Load) -> Split {
        self.decide(mode, load);
        let brake_nm = self.brake_nm(mode, load);
        self.motor_nm = match mode {
            Allocation::BrakeOnly => V3::zeros(),
            Allocation::MotorOnly | Allocation::MotorAndBrake => {
                V3::from_fn(|i, _| self.motor_share_nm(load, i))
            }
        };
        let relief_nm = self.relief_nm(mode, load);
        Split {
            motor_nm: load.motor_only_nm + self.motor_nm + relief_nm,
            brake_nm,
            usable: core::array::from_fn(|i| self.acts(i)),
        }
    }

    /// Whether the brake on `joint` may act.
    fn acts(&self, joint: usize) -> bool {
        self.usable[joint] || self.holding[joint]
    }

    /// Torque with which motors help a hand that pulls against brakes that have been let go, N·m.
    fn relief_nm(&self, mode: Allocation, load: &Load) -> V3 {
        let relief_nm = |i: usize| {
            let decay = Decay {
                brake_nm: load.brake_nm[i],
                qd: load.qd[i],
                hand_nm: load.hand_torque_nm[i],
                other_nm: self.other_nm(load, i),
            };
            decay.relief_nm(&self.model)
        };
        V3::from_fn(|i, _| match mode {
            Allocation::BrakeOnly => 0.0,
            _ if self.acts(i) => 0.0,
            _ => relief_nm(i),
        })
    }

    /// Torque of hand and motors on `joint`, N·m.
    fn other_nm(&self, load: &Load, joint: usize) -> f64 {
        load.hand_torque_nm[joint] + load.motor_only_nm[joint] + self.motor_nm[joint]
    }

    fn decide(&mut self, mode: Allocation, load: &Load) {
        let motors = mode == Allocation::MotorOnly;
        let shares = !motors && !releasing(&self.model, load);
        let holds = !motors && !letting_go(&self.model, load);
        let model = self.model;
        for i in 0..3 {
            let (qd, hand_nm) = (load.qd[i], load.hand_torque_nm[i]);
            let share = usable(&model, self.usable[i], load.torque_nm[i], qd, hand_nm);
            let holding = Holding {
                hold_nm: load.hold_nm[i],
                qd,
                hand_nm,
                other_nm: self.other_nm(load, i),
            };
            self.usable[i] = shares && share;
            self.holding[i] = holds && may_hold(&model, self.holding[i], &holding);
        }
    }

    fn brake_nm(&self, mode: Allocation, load: &Load) -> V3 {
        let lone = mode == Allocation::BrakeOnly
            && self.usable.iter().filter(|usable| **usable).count() == 1;
        V3::from_fn(|i, _| {
            let shared_nm = match (self.usable[i], lone) {
                (false, _) => 0.0,
                (true, true) => lone_brake_nm(load, i),
                (true, false) => load.torque_nm[i].abs(),
            };
            let wanted_nm = shared_nm + self.held_nm(load, i).abs();
            wanted_nm.min(self.model.torque_max_nm[i])
        })
    }

    fn held_nm(&self, load: &Load, joint: usize) -> f64 {
        if self.holding[joint] {
            load.hold_nm[joint]
        } else {
            0.0
        }
    }

    /// τ_m: what the brake, which acts against the motion, leaves open. At rest the brake only
    /// reacts, so that the motor hands over slowly what the brake can hold by now.
    fn motor_share_nm(&self, load: &Load, joint: usize) -> f64 {
        let (wanted, built_up) = (load.torque_nm[joint], load.brake_nm[joint]);
        if load.qd[joint].abs() >= self.model.omega_off_rad_per_s {
            let sense = (load.qd[joint] / self.model.omega_on_rad_per_s).clamp(-1.0, 1.0);
            bridge_nm(wanted, self.held_nm(load, joint), -sense * built_up)
        } else if self.usable[joint] {
            let left_open = wanted.signum() * (wanted.abs() - built_up).max(0.0);
            self.motor_nm[joint] + self.hand_over * (left_open - self.motor_nm[joint])
        } else {
            wanted
        }
    }
}

/// The least motor torque, N·m, with which a brake that gives `brake_nm` comes to `wanted_nm`, or
/// to anything between that and what it may hold beside it: the motor bridges the brake's rise and
/// cancels its decay, and does not work against a brake that is to hold.
#[must_use]
pub fn bridge_nm(wanted_nm: f64, hold_nm: f64, brake_nm: f64) -> f64 {
    let to_wanted = wanted_nm - brake_nm;
    let to_held = to_wanted + hold_nm;
    // Not `clamp`: it panics where a bound is no number. This passes it on, and the bounds stop it.
    if to_wanted * to_held <= 0.0 {
        0.0
    } else if to_wanted.abs() < to_held.abs() {
        to_wanted
    } else {
        to_held
    }
}
