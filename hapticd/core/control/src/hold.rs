//! Brakes that hold the tip in a wall without spring (KS §4, Fig. 6).

use crate::couple::JointDemand;
use crate::estimate::JointState;
use crate::linear::V3;
use crate::model::{BrakeModel, LimitModel};
use crate::render::touch::Touch;

/// Speed into or out of a wall below which the tip counts as at rest, m/s: three times the noise
/// of the velocity estimate.
const REST_M_PER_S: f64 = 0.004;

/// Smallest push of the hand that a brake at rest answers, N: above the force sensor's drift.
const PUSH_MIN_N: f64 = 1.0;

/// The hold of one device.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    torque_max_nm: V3,
    force_max_n: f64,
}

impl Hold {
    /// Brakes of the given model.
    #[must_use]
    pub fn new(brakes: &BrakeModel, limits: &LimitModel) -> Self {
        Self {
            torque_max_nm: brakes.torque_max_nm.into(),
            force_max_n: limits.tip_force_n,
        }
    }

    /// Lets the brakes hold in every wall that the tip goes into, or that the hand pushes it
    /// against. They let go once the tip moves out or the hand unloads.
    pub fn demand(
        &self,
        touches: &[Touch],
        state: &JointState,
        hand_force_n: Option<&V3>,
        demand: &mut JointDemand,
    ) {
        for touch in touches.iter().filter(|touch| touch.hold > 0.0) {
            let normal = &touch.push.normal;
            if holds(normal, &state.xd, hand_force_n) {
                let force_n = touch.hold * self.capacity_n(normal, state) * normal;
                demand.add_hold(&state.jacobian, &force_n);
            }
        }
    }

    /// Largest force along `normal`, N, that the brakes give together.
    fn capacity_n(&self, normal: &V3, state: &JointState) -> f64 {
        let torque_nm = state.jacobian.tr_mul(normal).abs();
        let reach = |i: usize| {
            if torque_nm[i] > 0.0 {
                self.torque_max_nm[i] / torque_nm[i]
            } else {
                f64::INFINITY
            }
        };
        (0..3).map(reach).fold(self.force_max_n, f64::min)
    }
}

/// Whether brakes hold a tip moving at `xd`, m/s, in a wall with the given normal.
#[must_use]
pub fn holds(normal: &V3, xd: &V3, hand_force_n: Option<&V3>) -> bool {
    let closing = -normal.dot(xd);
    let pushed_n = hand_force_n.map_or(0.0, |force_n| -normal.dot(force_n));
    closing > REST_M_PER_S || (closing > -REST_M_PER_S && pushed_n > PUSH_MIN_N)
}
