//! What stands between set-point and tip: the spring drive's stiffness, or a virtual coupling
//! in front of torque-commanded motors.

use crate::estimate::JointState;
use crate::linear::V3;
use crate::mapping::JointSetPoint;
use crate::model::{SpringDriveModel, TorqueDriveModel};

/// What the coupling asks of the actuators, before any limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointDemand {
    /// Joint torque, N·m; for a spring drive what the voltage settles to.
    pub torque_nm: V3,
    /// Force at the tip, N; zero for a spring drive at a singularity.
    pub force_n: V3,
    /// e_W, V; zero for a torque drive.
    pub motor_v: V3,
}

/// e_W = k_T θ̇_Sd + K_D (θ̇_Sd − θ̇) + K_P (θ_Sd − θ) with θ = ρq (WN eq. 10), and the joint
/// torque ρ k_T/dR (e_W − k_T θ̇) it settles to across the residual resistance `dr_ohm`, Ω.
#[must_use]
pub fn spring_demand(
    model: &SpringDriveModel,
    state: &JointState,
    set_point: &JointSetPoint,
    dr_ohm: &V3,
) -> JointDemand {
    let ratio = V3::from(model.ratio);
    let k_t = V3::from(model.k_t_nm_per_a);
    let thetad_sd = ratio.component_mul(&set_point.qd_sd);
    let thetad = ratio.component_mul(&state.qd);
    let error = ratio.component_mul(&(set_point.q_sd - state.q));
    let motor_v = k_t.component_mul(&thetad_sd)
        + V3::from(model.k_d_v_s_per_rad).component_mul(&(thetad_sd - thetad))
        + V3::from(model.k_p_v_per_rad).component_mul(&error);
    let across_dr_v = motor_v - k_t.component_mul(&thetad);
    let torque_nm = torque_per_volt(model, dr_ohm).component_mul(&across_dr_v);
    JointDemand {
        torque_nm,
        force_n: state.jacobian_inverse.tr_mul(&torque_nm),
        motor_v,
    }
}

/// ρ k_T/dR, N·m/V: static joint torque per volt across the residual resistance. Zero for an
/// axis without residual resistance, which is an unused one.
#[must_use]
pub fn torque_per_volt(model: &SpringDriveModel, dr_ohm: &V3) -> V3 {
    V3::from_fn(|i, _| {
        if dr_ohm[i] > 0.0 {
            model.ratio[i] * model.k_t_nm_per_a[i] / dr_ohm[i]
        } else {
            0.0
        }
    })
}

/// K_DC at the joint, ρ² k_T K_P/dR, N·m/rad (WN eq. 13).
#[must_use]
pub fn dc_stiffness(model: &SpringDriveModel, dr_ohm: &V3) -> V3 {
    torque_per_volt(model, dr_ohm)
        .component_mul(&V3::from(model.ratio))
        .component_mul(&V3::from(model.k_p_v_per_rad))
}

/// F = k (x_Sd − x) + b (ẋ_Sd − ẋ), τ = JᵀF. Free space gives no force.
///
/// A wall does not pull: the damper is scaled down until the force has no component against
/// x_Sd − x. Scaled as a whole it stays dissipative, also at a corner.
#[must_use]
pub fn torque_demand(
    model: &TorqueDriveModel,
    state: &JointState,
    x_sd: &V3,
    xd_sd: &V3,
) -> JointDemand {
    let spring = model.stiffness_n_per_m * (x_sd - state.x);
    let damper = model.damping_n_s_per_m * (xd_sd - state.xd);
    let force_n = spring + damper_share(&spring, &damper) * damper;
    JointDemand {
        torque_nm: state.jacobian.tr_mul(&force_n),
        force_n,
        motor_v: V3::zeros(),
    }
}

/// Largest s in 0…1 with (spring + s·damper)·spring ≥ 0; 0 without a spring force.
fn damper_share(spring: &V3, damper: &V3) -> f64 {
    let push = spring.norm_squared();
    let pull = -damper.dot(spring);
    if push <= 0.0 {
        0.0
    } else if pull > push {
        push / pull
    } else {
        1.0
    }
}
