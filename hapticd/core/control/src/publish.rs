//! From everything a tick knew to its record.

use crate::actuator::Motors;
use crate::bound::Bounded;
use crate::brake::Brakes;
use crate::estimate::JointState;
use crate::io::{status, Command, Observation};
use crate::linear::V3;
use crate::record::{limit, TickRecord, NO_WALL};
use crate::render::Rendering;

/// Pose, motion and contact.
pub fn motion(record: &mut TickRecord, state: &JointState, rendering: &Rendering) {
    record.joint_position_rad = state.q.into();
    record.joint_velocity_rad_per_s = state.qd.into();
    record.tip_position_m = state.x.into();
    record.tip_velocity_m_per_s = state.xd.into();
    record.singularity_margin = state.singularity_margin;
    record.setpoint_position_m = rendering.set_point.x_sd.into();
    record.setpoint_velocity_m_per_s = rendering.set_point.xd_sd.into();
    record.stiffness_n_per_m = rendering.stiffness_n_per_m;
    let contact = &rendering.contact;
    record.contact_count = contact.count as u64;
    record.contact_wall = u64::try_from(contact.wall).unwrap_or(NO_WALL);
    record.contact_depth_m = contact.depth_m;
    record.contact_normal = contact.normal.into();
    record.joint_torque_demand_nm = rendering.demand.torque_nm.into();
    record.tip_force_demand_n = rendering.demand.force_n.into();
}

/// What the device reported.
pub fn observation(record: &mut TickRecord, observation: &Observation) {
    record.t_device_ns = observation.t_device_ns;
    record.observation_seq = observation.seq;
    record.observation_status = observation.status;
}

/// What went out.
pub fn command(record: &mut TickRecord, command: &Command, motor: &Bounded, state: &JointState) {
    record.motor_v = command.motor_v;
    record.brake_torque_nm = command.brake_torque_nm;
    record.motor_torque_nm = motor.torque_nm.into();
    record.tip_force_command_n = tip_force(state, &motor.torque_nm).into();
    record.limits |= motor.acted;
}

/// What the actuators give, by their models. `external_nm` is the joint torque of the hand, N·m.
pub fn actuators(
    record: &mut TickRecord,
    state: &JointState,
    motors: &Motors,
    brakes: Option<&Brakes>,
    external_nm: &V3,
) {
    let torque_nm = motors.torque_nm();
    record.motor_torque_estimate_nm = torque_nm.into();
    record.motor_current_a = motors.current_a().into();
    record.motor_temperature_c = motors.winding_c().into();
    record.motor_i2t = motors.budget().used().into();
    if motors.budget().folding() {
        record.limits |= limit::THERMAL;
    }
    let mut given_nm = torque_nm;
    if let Some(brakes) = brakes {
        record.brake_torque_estimate_nm = brakes.capacity_nm().into();
        given_nm += brakes.reaction_nm(&state.qd, &(torque_nm + external_nm));
    }
    record.tip_force_n = tip_force(state, &given_nm).into();
}

/// Flags of [`flag`] that hold.
#[must_use]
pub fn flags(pairs: &[(bool, u64)]) -> u64 {
    pairs
        .iter()
        .filter(|(holds, _)| *holds)
        .fold(0, |bits, (_, bit)| bits | bit)
}

/// One bit per joint.
#[must_use]
pub fn bits(joints: &[bool; 3]) -> u64 {
    (0..3).fold(0, |bits, i| bits | u64::from(joints[i]) << i)
}

/// The measured force of the hand on the device, N; zero where none is measured.
#[must_use]
pub fn measured_force_n(observation: &Observation) -> V3 {
    if observation.status & status::FORCE_PRESENT != 0 {
        observation.force_n.into()
    } else {
        V3::zeros()
    }
}

/// J⁻ᵀτ, N.
fn tip_force(state: &JointState, torque_nm: &V3) -> V3 {
    state.jacobian_inverse.tr_mul(torque_nm)
}
