//! Brakes that hold the hand in a wall without spring.

use crate::models::hhd;
use crate::rig::{scene, Rig};
use hapticd_control::linear::V3;
use hapticd_control::scene::{Allocation, Law, Scene, Wall};

/// Tip at rest 1 mm inside a damper wall whose normal points to the base.
fn inside(brake: bool, allocation: Allocation) -> (Rig, V3) {
    let mut rig = Rig::running(hhd());
    let tip = V3::from(rig.record.tip_position_m);
    let normal = -tip.normalize();
    let wall = Wall {
        law: Law::Damper {
            damping_n_s_per_m: 300.0,
        },
        brake,
        ..Wall::plane(1, normal.into(), normal.dot(&tip) + 0.001, 0.0)
    };
    rig.controller.adopt(&Scene {
        allocation,
        ..scene(&[wall], 0.0)
    });
    (rig, normal)
}

fn holding() -> (Rig, V3) {
    let (mut rig, normal) = inside(true, Allocation::MotorAndBrake);
    rig.hand(-27.0 * normal);
    rig.steps(200);
    (rig, normal)
}

/// Moves the tip by `speed` along `along` for one tick.
fn slide(rig: &mut Rig, along: &V3, speed: f64) {
    let q = V3::from(rig.record.joint_position_rad);
    let kinematics = rig.model.kinematics;
    let inverse = kinematics.jacobian_inverse(&q).expect("not singular");
    rig.place(&(q + inverse * (along * speed * 1e-3)));
    rig.step();
}

#[test]
fn brakes_hold_a_resting_hand_with_all_they_have_and_motors_rest() {
    let (rig, normal) = holding();
    assert_eq!(rig.record.brake_usable, 0b11);
    assert!((V3::from(rig.record.brake_torque_nm).amax() - 10.0).abs() < 1e-9);
    assert!(V3::from(rig.record.motor_torque_nm).norm() < 1e-9);
    let given_n = V3::from(rig.record.tip_force_n);
    assert!((given_n - 27.0 * normal).norm() < 0.5, "{given_n}");
}

#[test]
fn brakes_let_go_when_the_hand_unloads_and_when_the_tip_leaves() {
    let (mut rig, normal) = holding();
    rig.hand(-0.5 * normal);
    rig.step();
    assert_eq!(rig.record.brake_torque_nm, [0.0; 3]);
    let (mut rig, normal) = holding();
    for _ in 0..20 {
        slide(&mut rig, &normal, 0.05);
    }
    assert!(rig.record.contact_depth_m > 0.0, "still inside");
    assert_eq!(rig.record.brake_torque_nm, [0.0; 3]);
}

#[test]
fn motors_cancel_what_is_left_of_the_brakes_while_the_tip_leaves() {
    let (mut rig, normal) = holding();
    rig.hand(V3::zeros());
    for _ in 0..15 {
        slide(&mut rig, &normal, 0.06);
    }
    let left_nm = V3::from(rig.record.brake_torque_estimate_nm) - V3::new(0.4, 0.4, 0.0);
    assert!(left_nm.amin() >= 0.0 && left_nm.amax() > 3.0, "{left_nm}");
    let qd = V3::from(rig.record.joint_velocity_rad_per_s);
    let motor_nm = V3::from(rig.record.motor_torque_nm);
    for i in 0..2 {
        assert!(
            (motor_nm[i] * qd[i].signum() - left_nm[i]).abs() < 0.5,
            "{motor_nm}"
        );
    }
}

#[test]
fn motors_bridge_the_rise_of_the_brakes() {
    let (mut rig, normal) = inside(true, Allocation::MotorAndBrake);
    rig.hand(-27.0 * normal);
    let mut earlier_n = f64::INFINITY;
    for tick in 0..120 {
        slide(&mut rig, &-normal, 0.1);
        if tick % 40 == 39 {
            let motor_n = V3::from(rig.record.tip_force_command_n).norm();
            assert!(
                motor_n < earlier_n - 1.0 || motor_n == 0.0,
                "{motor_n} after {earlier_n}"
            );
            earlier_n = motor_n;
        }
    }
    assert!(V3::from(rig.record.tip_force_demand_n).norm() > 20.0);
}

#[test]
fn nothing_is_held_without_brakes_or_where_the_wall_bars_them() {
    for (brake, allocation) in [
        (false, Allocation::MotorAndBrake),
        (true, Allocation::MotorOnly),
    ] {
        let (mut rig, normal) = inside(brake, allocation);
        rig.hand(-27.0 * normal);
        rig.steps(50);
        assert_eq!(rig.record.brake_torque_nm, [0.0; 3]);
    }
}

#[test]
fn hold_comes_and_goes_with_its_scene() {
    let (mut rig, normal) = holding();
    let held_nm = V3::from(rig.record.hold_torque_nm).norm();
    rig.controller.adopt(&scene(&[], 0.1));
    rig.hand(-27.0 * normal);
    let mut before_nm = held_nm;
    for _ in 0..100 {
        rig.step();
        let now_nm = V3::from(rig.record.hold_torque_nm).norm();
        assert!(now_nm <= before_nm && before_nm - now_nm < 0.02 * held_nm);
        before_nm = now_nm;
    }
    assert!(before_nm < 1e-6 * held_nm);
}
