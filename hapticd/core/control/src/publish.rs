//! From everything a tick knew to its record.

use crate::bits;
use crate::estimate::JointState;
use crate::friction::FrictionForce;
use crate::io::{status, Observation};
use crate::linear::V3;
use crate::record::{limit, TickRecord, NO_WALL};
use crate::render::Rendering;
use crate::stage::Stage;

/// What the device reported.
pub fn observation(record: &mut TickRecord, observation: &Observation) {
    record.t_device_ns = observation.t_device_ns;
    record.observation_seq = observation.seq;
    record.observation_status = observation.status;
    let present = observation.status & status::FORCE_PRESENT != 0;
    record.sensor_force_n = if present {
        observation.force_n
    } else {
        [0.0; 3]
    };
}

/// Pose, motion, contact and demand.
pub fn motion(record: &mut TickRecord, pose: &JointState, rendering: &Rendering) {
    record.joint_position_rad = pose.q.into();
    record.joint_velocity_rad_per_s = pose.qd.into();
    record.tip_position_m = pose.x.into();
    record.tip_velocity_m_per_s = pose.xd.into();
    record.singularity_margin = pose.singularity_margin;
    record.setpoint_position_m = rendering.set_point.x_sd.into();
    record.setpoint_velocity_m_per_s = rendering.set_point.xd_sd.into();
    record.stiffness_n_per_m = rendering.stiffness_n_per_m;
    let contact = &rendering.contact;
    record.contact_count = contact.count as u64;
    record.contact_wall = named(contact.wall);
    record.touched_walls = contact.touched.map(named);
    record.touched_force_n = rendering.touched_force_n.into();
    record.proxy_position_m = contact.proxy.into();
    record.passivity_wall = NO_WALL;
    record.contact_depth_m = contact.depth_m;
    record.contact_normal = contact.normal.into();
    record.joint_torque_demand_nm = rendering.demand.torque_nm.into();
    record.shared_torque_nm = rendering.demand.shared_nm().into();
    record.hold_torque_nm = rendering.demand.hold_nm.into();
    record.tip_force_demand_n = rendering.demand.force_n.into();
    friction(record, &rendering.friction);
}

fn friction(record: &mut TickRecord, friction: &FrictionForce) {
    record.friction_force_n = (friction.motor_n + friction.brake_n).into();
    record.friction_state = friction.state as u64;
}

fn named(wall: usize) -> u64 {
    if wall == usize::MAX {
        NO_WALL
    } else {
        wall as u64
    }
}

/// What went out.
pub fn command(record: &mut TickRecord, stage: &Stage, pose: &JointState) {
    let sent = stage.sent();
    record.motor_v = sent.command.motor_v;
    record.brake_torque_nm = sent.command.brake_torque_nm;
    record.motor_torque_nm = sent.motor_nm.into();
    record.tip_force_command_n = tip_force_n(pose, &sent.motor_nm).into();
    record.brake_usable = bits::joints(&sent.usable);
    record.gain = stage.gain();
    let folding = stage.motors().budget().folding();
    record.limits = bits::union(&[(true, sent.acted), (folding, limit::THERMAL)]);
}

/// What the actuators give, by their models. At rest the brakes hold against the motors and the
/// hand.
pub fn actuators(record: &mut TickRecord, stage: &Stage, pose: &JointState) {
    let motors = stage.motors();
    let motor_nm = motors.torque_nm();
    record.motor_torque_estimate_nm = motor_nm.into();
    record.motor_current_a = motors.current_a().into();
    record.motor_temperature_c = motors.winding_c().into();
    record.motor_i2t = motors.budget().used().into();
    let mut given_nm = motor_nm;
    if let Some(brakes) = stage.brakes() {
        let hand_nm = pose.jacobian.tr_mul(&V3::from(record.sensor_force_n));
        record.brake_torque_estimate_nm = brakes.capacity_nm().into();
        given_nm += brakes.reaction_nm(&pose.qd, &(motor_nm + hand_nm));
    }
    record.tip_force_n = tip_force_n(pose, &given_nm).into();
}

/// J⁻ᵀτ, N.
fn tip_force_n(pose: &JointState, torque_nm: &V3) -> V3 {
    pose.jacobian_inverse.tr_mul(torque_nm)
}
