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

    /// Shares `share` of the torque wanted between motors and brakes.
    pub fn split(&mut self, wanted: &Wanted<'_>, share: f64) -> Split {
        let load = Load {
            torque_nm: share * wanted.demand.torque_nm,
            force_n: share * wanted.demand.force_n,
            force_per_torque: wanted.pose.jacobian_inverse.transpose(),
            qd: wanted.pose.qd,
            hand_torque_nm: wanted.pose.jacobian.tr_mul(&wanted.hand_force_n),
            hand_force_n: wanted.hand_force_n,
            brake_nm: self.brakes.torque_nm(),
        };
        self.allocator.split(wanted.allocation, &load)
    }

    /// Bounds what is asked of the brakes, N·m, `before_nm` being what was sent last; and the
    /// limits that acted, bits of [`limit`].
    #[must_use]
    pub fn bound(&self, asked_nm: &V3, before_nm: &V3, wanted: &Wanted<'_>) -> (V3, u64) {
        let brake_nm = V3::from_fn(|i, _| {
            bound_brake(&BrakeAsk {
                asked_nm: asked_nm[i],
                before_nm: before_nm[i],
                wanted_nm: wanted.demand.torque_nm[i],
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
