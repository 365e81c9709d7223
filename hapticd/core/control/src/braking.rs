//! The brakes of a device: their model, their share of the torque, their bounds.

use crate::allocate::{Allocator, Load, Split};
use crate::bound::{bound_brake, BrakeAsk};
use crate::brake::Brakes;
use crate::linear::V3;
use crate::model::{BrakeModel, LimitModel};
use crate::record::limit;
use crate::stage::Wanted;

/// Brakes, and the logic that shares torque with them.
#[derive(Clone, Debug)]
pub struct Braking {
    model: BrakeModel,
    rise_nm: f64,
    tip_force_n: f64,
    brakes: Brakes,
    allocator: Allocator,
}

impl Braking {
    /// Brakes released and at rest, used every `period_s`.
    #[must_use]
    pub fn new(model: &BrakeModel, limits: &LimitModel, period_s: f64) -> Self {
        Self {
            model: *model,
            rise_nm: limits.brake_slew_nm_per_s * period_s,
            tip_force_n: limits.tip_force_n,
            brakes: Brakes::new(model, period_s),
            allocator: Allocator::new(model, period_s),
        }
    }

    /// The brakes, as modelled.
    #[must_use]
    pub fn brakes(&self) -> &Brakes {
        &self.brakes
    }

    /// Whether brakes keep their torque when outputs are withdrawn.
    #[must_use]
    pub fn holds_on_stop(&self) -> bool {
        !self.model.release_on_stop
    }

    /// Lets the brake model follow what was asked, N·m.
    pub fn step(&mut self, asked_nm: &V3) {
        self.brakes.step(asked_nm);
    }

    /// Shares `share` of the torque wanted between motors and brakes, which may hold as far as the
    /// tip's limit leaves room.
    pub fn split(&mut self, wanted: &Wanted<'_>, share: f64) -> Split {
        let (demand, pose) = (wanted.demand, wanted.pose);
        let shared_nm = demand.shared_nm();
        let load = Load {
            torque_nm: share * shared_nm,
            force_n: share * self.shared_force_n(wanted),
            hold_nm: self.room(wanted, share) * demand.hold_nm,
            motor_only_nm: share * demand.motor_only_nm,
            force_per_torque: pose.jacobian_inverse.transpose(),
            qd: pose.qd,
            hand_torque_nm: pose.jacobian.tr_mul(&wanted.hand_force_n),
            hand_force_n: wanted.hand_force_n,
            brake_nm: self.brakes.torque_nm(),
        };
        self.allocator.split(wanted.allocation, &load)
    }

    /// Force that motors and brakes share, N.
    fn shared_force_n(&self, wanted: &Wanted<'_>) -> V3 {
        let motor_only_nm = &wanted.demand.motor_only_nm;
        wanted.demand.force_n - wanted.pose.jacobian_inverse.tr_mul(motor_only_nm)
    }

    /// Largest share of the hold that keeps the whole force within the tip's limit (law 1).
    fn room(&self, wanted: &Wanted<'_>, share: f64) -> f64 {
        let inverse = &wanted.pose.jacobian_inverse;
        let held_n = inverse.tr_mul(&wanted.demand.hold_nm).norm();
        let given_n = share * inverse.tr_mul(&wanted.demand.torque_nm).norm();
        if held_n > 0.0 {
            ((self.tip_force_n - given_n) / held_n).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// Bounds what is asked of the brakes, N·m, `before_nm` being what was sent last; and the
    /// limits that acted, bits of [`limit`].
    #[must_use]
    pub fn bound(&self, asked_nm: &V3, before_nm: &V3, wanted: &Wanted<'_>) -> (V3, u64) {
        let brake_nm = V3::from_fn(|i, _| {
            bound_brake(&BrakeAsk {
                asked_nm: asked_nm[i],
                before_nm: before_nm[i],
                wanted_nm: against_motion_nm(wanted, i),
                qd: wanted.pose.qd[i],
                max_nm: self.model.torque_max_nm[i],
                rise_nm: self.rise_nm,
                omega_off: self.model.omega_off_rad_per_s,
            })
        });
        let acted = if brake_nm == *asked_nm {
            0
        } else {
            limit::BRAKE
        };
        (brake_nm, acted)
    }
}

/// Torque wanted of a brake, N·m: what it shares and what it holds, as far as that is against the
/// motion of its joint.
fn against_motion_nm(wanted: &Wanted<'_>, joint: usize) -> f64 {
    let qd = wanted.pose.qd[joint];
    let parts = [
        wanted.demand.shared_nm()[joint],
        wanted.demand.hold_nm[joint],
    ];
    parts.iter().filter(|part| *part * qd < 0.0).sum()
}
