//! What stands between set-point and tip: the spring drive's stiffness, or a virtual coupling
//! in front of torque-commanded motors.

use crate::estimate::JointState;
use crate::law::spring::damper_share;
use crate::linear::{M3, V3};
use crate::mapping::JointSetPoint;
use crate::model::SpringDriveModel;

/// What the coupling asks of the actuators, before any limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointDemand {
    /// Joint torque wanted of motors and brakes, N·m; for a spring drive what the voltage settles
    /// to.
    pub torque_nm: V3,
    /// Part of it that motors alone give, N·m.
    pub motor_only_nm: V3,
    /// Torque that brakes alone may add, N·m: it only ever acts against the motion.
    pub hold_nm: V3,
    /// Force at the tip, N; zero for a spring drive at a singularity.
    pub force_n: V3,
    /// e_W of the set-point, V; zero for a torque drive.
    pub motor_v: V3,
}

impl JointDemand {
    /// Asks for one more tip force, N, of motors and brakes together.
    pub fn add_shared(&mut self, jacobian: &M3, force_n: &V3) {
        self.torque_nm += jacobian.tr_mul(force_n);
        self.force_n += force_n;
    }

    /// Asks for one more tip force, N, of the motors alone.
    pub fn add_motor_only(&mut self, jacobian: &M3, force_n: &V3) {
        self.add_shared(jacobian, force_n);
        self.motor_only_nm += jacobian.tr_mul(force_n);
    }

    /// Lets brakes hold the tip with up to one more force, N.
    pub fn add_hold(&mut self, jacobian: &M3, force_n: &V3) {
        self.hold_nm += jacobian.tr_mul(force_n);
    }

    /// Joint torque that motors and brakes share, N·m.
    #[must_use]
    pub fn shared_nm(&self) -> V3 {
        self.torque_nm - self.motor_only_nm
    }
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
        ..JointDemand::default()
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

/// F = spring + s·damper, N, τ = JᵀF, with the share s at which no wall pulls; free space gives no
/// force. Of a set-point: spring k (x_Sd − x) and damper b (ẋ_Sd − ẋ).
#[must_use]
pub fn torque_demand(jacobian: &M3, spring_n: &V3, damper_n: &V3) -> JointDemand {
    let mut demand = JointDemand::default();
    let force_n = spring_n + damper_share(spring_n, damper_n) * damper_n;
    demand.add_shared(jacobian, &force_n);
    demand
}
