//! The bounding layer: the last word on every output. Small pure functions, one per limit; each
//! names the law of docs/safety.md that it enforces.

use crate::actuator::Supply;
use crate::bits;
use crate::linear::{M3, V3};
use crate::model::LimitModel;
use crate::record::limit;

/// What the bounds depend on in one tick.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<'a> {
    /// Limits of the device.
    pub limits: &'a LimitModel,
    /// Tick period, s.
    pub period_s: f64,
    /// Factor of state and singularity, 0 to 1.
    pub fade: f64,
    /// J⁻¹, rad/m.
    pub jacobian_inverse: &'a M3,
    /// Largest joint torque now, N·m.
    pub peak_nm: V3,
    /// Joint torque the motors give at present, N·m.
    pub present_nm: V3,
    /// Share of it that is left after one period.
    pub retain: V3,
    /// The supply of a spring drive.
    pub supply: Option<Supply>,
}

/// A bounded value, and the limits that acted on it, bits of [`limit`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounded {
    /// Joint torque, N·m.
    pub torque_nm: V3,
    /// Bits of [`limit`].
    pub acted: u64,
}

/// Bounds the motors' joint torque (laws 1, 2, 3): fade, then one common factor for current,
/// tip force and volts, so that the force keeps its direction, then the slew limit.
///
/// The limits have the last word over the slew limit: they only ever take the torque towards
/// zero. A value that is not finite makes all of it zero and says so.
#[must_use]
pub fn bound_motor(asked_nm: &V3, bounds: &Bounds<'_>) -> Bounded {
    if !finite(asked_nm) {
        return Bounded {
            torque_nm: V3::zeros(),
            acted: limit::NON_FINITE,
        };
    }
    let target = limited(&(bounds.fade * asked_nm), bounds);
    let step_nm = target.torque_nm - bounds.present_nm;
    let share = slew_share(&step_nm, bounds);
    // The present torque may lie outside: pose, speed or budget moved the limits.
    let last = limited(&(bounds.present_nm + share * step_nm), bounds);
    Bounded {
        torque_nm: last.torque_nm,
        acted: bits::union(&[
            (true, target.acted),
            (true, last.acted),
            (share < 1.0, limit::SLEW),
        ]),
    }
}

/// Whether every component is finite (law 1).
#[must_use]
pub fn finite(values: &V3) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// Factor near a singularity: 1 above `margin_limit`, 0 below half of it, smooth between. Past
/// zero the tip force of a joint torque is not known, and no limit on it could be held (law 1).
#[must_use]
pub fn singularity_fade(margin: f64, margin_limit: f64) -> f64 {
    let s = (2.0 * margin / margin_limit - 1.0).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

/// Largest factor, at most 1, that keeps every |τ_i| within `peak_nm` (law 1).
#[must_use]
pub fn joint_share(torque_nm: &V3, peak_nm: &V3) -> f64 {
    let share = |torque: f64, peak: f64| {
        if torque.abs() > peak {
            peak / torque.abs()
        } else {
            1.0
        }
    };
    torque_nm.zip_map(peak_nm, share).min()
}

/// Largest factor, at most 1, that keeps ‖J⁻ᵀτ‖ within `force_n` (law 1).
#[must_use]
pub fn tip_share(torque_nm: &V3, jacobian_inverse: &M3, force_n: f64) -> f64 {
    let asked_n = jacobian_inverse.tr_mul(torque_nm).norm();
    if asked_n > force_n {
        force_n / asked_n
    } else {
        1.0
    }
}

/// Largest factor, 0 to 1, on the torque part of e_W = k_T θ̇ + τ dR/(ρ k_T) that keeps |e_W|
/// within the supply (law 1). 0 where the back-EMF alone fills it.
#[must_use]
pub fn voltage_share(torque_nm: &V3, supply: &Supply) -> f64 {
    let share = |i: usize| {
        let part_v = supply.v_per_nm[i] * torque_nm[i];
        let room_v = supply.max_v[i] - part_v.signum() * supply.emf_v[i];
        if part_v.abs() > room_v {
            (room_v / part_v.abs()).max(0.0)
        } else {
            1.0
        }
    };
    (0..3).map(share).fold(1.0, f64::min)
}

/// Share of a step of the commanded torque, N·m, after which the predicted change of tip force in
/// this period, ‖J⁻ᵀ(1−a)Δτ‖, is within the slew limit (law 3).
#[must_use]
pub fn slew_share(step_nm: &V3, bounds: &Bounds<'_>) -> f64 {
    let predicted_nm = step_nm - bounds.retain.component_mul(step_nm);
    let slew_n = bounds.limits.tip_slew_n_per_s * bounds.period_s;
    tip_share(&predicted_nm, bounds.jacobian_inverse, slew_n)
}

/// Scales a torque as a whole into current, tip force and supply.
fn limited(torque_nm: &V3, bounds: &Bounds<'_>) -> Bounded {
    let joint = joint_share(torque_nm, &bounds.peak_nm);
    let tip = tip_share(
        torque_nm,
        bounds.jacobian_inverse,
        bounds.limits.tip_force_n,
    );
    let volts = bounds
        .supply
        .map_or(1.0, |supply| voltage_share(torque_nm, &supply));
    Bounded {
        torque_nm: joint.min(tip).min(volts) * torque_nm,
        acted: bits::union(&[
            (joint < 1.0, limit::MOTOR_TORQUE),
            (tip < 1.0, limit::TIP_FORCE),
            (volts < 1.0, limit::VOLTAGE),
        ]),
    }
}

/// What one brake is asked, and what it meets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrakeAsk {
    /// Torque asked, faded, N·m.
    pub asked_nm: f64,
    /// Torque sent in the last tick, N·m.
    pub before_nm: f64,
    /// Joint torque wanted, τ_d, N·m.
    pub wanted_nm: f64,
    /// Joint velocity, rad/s.
    pub qd: f64,
    /// Largest torque of the brake, N·m.
    pub max_nm: f64,
    /// Largest rise in one tick, N·m.
    pub rise_nm: f64,
    /// |q̇| below which its sign is noise, rad/s.
    pub omega_off: f64,
}

/// Bounds one brake: 0…max (law 1), rising no faster than its slew limit (law 3), and nothing in
/// the direction of motion, whatever the allocation decided (law 7). Letting go is never slowed.
#[must_use]
pub fn bound_brake(ask: &BrakeAsk) -> f64 {
    if !dissipates(ask.wanted_nm, ask.qd, ask.omega_off) {
        return 0.0;
    }
    // `max` first: it turns a NaN into zero.
    ask.asked_nm
        .max(0.0)
        .min(ask.max_nm)
        .min(ask.before_nm + ask.rise_nm)
}

/// Whether a brake may act: not while the joint moves the way its torque is wanted (law 7).
#[must_use]
pub fn dissipates(wanted_nm: f64, qd: f64, omega_off: f64) -> bool {
    qd.abs() <= omega_off || wanted_nm * qd < 0.0
}
