//! From a set-point of the tip to set-points of the joints, and how stiff that may be.

use crate::environment::SetPoint;
use crate::estimate::JointState;
use crate::linear::{invert_axes, lambda_max_sym, M3, V3};
use crate::model::{DeviceModel, KinematicsModel};
use crate::scene::Mapping;

/// Steps per joint of the search over the workspace: 2° or less, where the bound changes by
/// less than 0.1 % a step.
const WORKSPACE_STEPS: usize = 96;

/// Where the joints are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointSetPoint {
    /// q_Sd, rad.
    pub q_sd: V3,
    /// q̇_Sd, rad/s.
    pub qd_sd: V3,
}

/// Largest isotropic tip stiffness k_c, N/m, that makes no joint direction stiffer than
/// `k_q`, N·m/rad: λ_min(J⁻ᵀ K_q J⁻¹) = 1/λ_max(J K_q⁻¹ Jᵀ) (WN eq. 28–29, physics §3.3).
///
/// Zero where a joint in use has no stiffness.
#[must_use]
pub fn isotropic_stiffness(jacobian: &M3, k_q: &V3) -> f64 {
    let soft = |i: usize| k_q[i] <= 0.0 && jacobian.column(i).amax() > 0.0;
    if (0..3).any(soft) {
        return 0.0;
    }
    let compliance = jacobian * M3::from_diagonal(&invert_axes(k_q)) * jacobian.transpose();
    let lambda_max = lambda_max_sym(&compliance);
    if lambda_max > 0.0 {
        lambda_max.recip()
    } else {
        0.0
    }
}

/// Smallest [`isotropic_stiffness`], N/m, over every pose inside the limits: one stiffness for
/// the whole workspace (WN §V after eq. 29). A search for start-up, not for the tick.
#[must_use]
pub fn workspace_stiffness(model: &DeviceModel, k_q: &V3) -> f64 {
    let coupling = model.kinematics.coupling();
    let (min, max) = (model.joints.min_rad, model.joints.max_rad);
    let mut q = V3::from(model.joints.home_rad);
    let mut smallest = f64::INFINITY;
    for from in steps(min[coupling.from], max[coupling.from]) {
        let low = min[coupling.to].max(from + coupling.min_rad);
        let high = max[coupling.to].min(from + coupling.max_rad);
        for to in steps(low, high) {
            q[coupling.from] = from;
            q[coupling.to] = to;
            let jacobian = model.kinematics.jacobian(&q);
            smallest = smallest.min(isotropic_stiffness(&jacobian, k_q));
        }
    }
    smallest
}

/// Equal steps over a range, both ends included; none where the range is empty.
fn steps(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let count = if low <= high { WORKSPACE_STEPS + 1 } else { 0 };
    (0..count).map(move |i| low + (high - low) * i as f64 / WORKSPACE_STEPS as f64)
}

/// Joint set-point of a tip set-point, with joint stiffness `k_q`, N·m/rad, and tip stiffness
/// `k_c`, N/m, at most [`isotropic_stiffness`].
#[must_use]
pub fn joint_set_point(
    mapping: Mapping,
    kinematics: &KinematicsModel,
    state: &JointState,
    set_point: &SetPoint,
    k_q: &V3,
    k_c: f64,
) -> JointSetPoint {
    match mapping {
        Mapping::Transpose => transpose(state, set_point, k_q, k_c),
        Mapping::Inverse => inverse(kinematics, state, set_point),
    }
}

/// q_Sd = q + K_q⁻¹ Jᵀ k_c (x_Sd − x), and the same for velocities (WN eq. 23–24 for unequal
/// joints, physics §3.3): the static force is k_c (x_Sd − x), in the direction asked for.
fn transpose(state: &JointState, set_point: &SetPoint, k_q: &V3, k_c: f64) -> JointSetPoint {
    let softness = k_c * invert_axes(k_q);
    let to_joints = |tip: V3| softness.component_mul(&state.jacobian.tr_mul(&tip));
    JointSetPoint {
        q_sd: state.q + to_joints(set_point.x_sd - state.x),
        qd_sd: state.qd + to_joints(set_point.xd_sd - state.xd),
    }
}

/// q_Sd = invkin(x_Sd), q̇_Sd = J⁻¹ ẋ_Sd (WN eq. 18). Linearised where the set-point is out of
/// reach. The velocity is written from q̇, so that a singular pose leaves the joints free.
fn inverse(
    kinematics: &KinematicsModel,
    state: &JointState,
    set_point: &SetPoint,
) -> JointSetPoint {
    let to_joints = |tip: V3| state.jacobian_inverse * tip;
    let linearised = || state.q + to_joints(set_point.x_sd - state.x);
    JointSetPoint {
        q_sd: kinematics
            .inverse(&set_point.x_sd)
            .unwrap_or_else(linearised),
        qd_sd: state.qd + to_joints(set_point.xd_sd - state.xd),
    }
}
