//! The whole tick with brakes that share the load.

use crate::models::{hhd, torque_drive};
use crate::rig::{ask, fade_out, is_zero, scene, tip_force_n, Rig};
use hapticd_control::controller::Event;
use hapticd_control::fault::Fault;
use hapticd_control::io::status;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::limit;
use hapticd_control::scene::{Allocation, Scene, Wall};

/// Pressed into a wall that answers the hand's 20 N.
fn with_mode(rig: &mut Rig, allocation: Allocation) {
    let depth_m = 20.0 / torque_drive().stiffness_n_per_m;
    let tip = V3::from(rig.record.tip_position_m);
    let normal = -tip.normalize();
    let wall = Wall::plane(1, normal.into(), normal.dot(&tip) + depth_m, 0.0);
    let scene = Scene {
        allocation,
        ..scene(&[wall], 0.0)
    };
    rig.hand(-20.0 * normal);
    rig.controller.adopt(&scene);
}

#[test]
fn brakes_take_over_at_rest_and_the_motors_let_go() {
    let mut rig = Rig::running(hhd());
    with_mode(&mut rig, Allocation::MotorAndBrake);
    rig.steps(400);
    assert_eq!(rig.record.brake_usable, 0b11);
    assert!(rig.record.brake_torque_nm[..2].iter().all(|nm| *nm > 0.5));
    assert!(V3::from(rig.record.motor_torque_nm).amax() < 0.6);
    let pushed_n = V3::from(rig.record.sensor_force_n);
    let given_n = V3::from(rig.record.tip_force_n);
    assert!((given_n + pushed_n).norm() < 0.5, "{given_n}");
}

#[test]
fn motor_only_mode_leaves_the_brakes_off_and_brake_only_the_motors() {
    let mut rig = Rig::running(hhd());
    with_mode(&mut rig, Allocation::MotorOnly);
    rig.steps(100);
    assert_eq!(rig.command.brake_torque_nm, [0.0; 3]);
    assert!(V3::from(rig.record.motor_torque_nm).amax() > 1.0);
    with_mode(&mut rig, Allocation::BrakeOnly);
    rig.steps(100);
    assert!(V3::from(rig.record.motor_torque_nm).amax() < 1e-9);
    assert!(rig.command.brake_torque_nm[0] > 0.5);
}

#[test]
fn brakes_let_go_as_soon_as_the_hand_unloads() {
    let mut rig = Rig::running(hhd());
    with_mode(&mut rig, Allocation::MotorAndBrake);
    rig.steps(200);
    rig.hand(V3::zeros());
    rig.step();
    assert_eq!(rig.command.brake_torque_nm, [0.0; 3]);
    assert_eq!(rig.record.brake_usable, 0);
}

#[test]
fn force_of_a_faulty_sensor_decides_nothing() {
    for (bit, fault) in [
        (status::SENSOR_SATURATED, Fault::SensorSaturated),
        (status::FORCE_PRESENT, Fault::SensorStale),
    ] {
        let mut rig = Rig::running(hhd());
        with_mode(&mut rig, Allocation::MotorAndBrake);
        rig.steps(200);
        rig.observation.status ^= bit;
        rig.step();
        assert!(rig.has(fault));
        assert!(rig.command.enable, "cut instead of faded");
        assert_eq!(rig.command.brake_torque_nm, [0.0; 3]);
        rig.observation.status ^= bit;
        rig.step();
        assert_eq!(rig.command.brake_torque_nm, [0.0; 3], "still latched");
    }
}

#[test]
fn brake_that_rises_too_fast_says_so() {
    let mut model = hhd();
    model.limits.brake_slew_nm_per_s = 100.0;
    let mut rig = Rig::running(model);
    with_mode(&mut rig, Allocation::MotorAndBrake);
    rig.steps(3);
    assert_ne!(rig.record.limits & limit::BRAKE, 0);
    assert!((rig.command.brake_torque_nm[0] - 0.3).abs() < 1e-9);
    rig.steps(100);
    assert_eq!(rig.record.limits & limit::BRAKE, 0);
}

fn holding() -> DeviceModel {
    let mut model = hhd();
    if let Some(brakes) = &mut model.brakes {
        brakes.release_on_stop = false;
    }
    model
}

#[test]
fn brakes_fade_when_outputs_are_withdrawn_if_they_are_to_release() {
    let mut rig = Rig::running(hhd());
    with_mode(&mut rig, Allocation::MotorAndBrake);
    rig.steps(200);
    let held_nm = rig.command.brake_torque_nm[0];
    ask(&mut rig, Event::Disable);
    rig.steps(50);
    let left = rig.command.brake_torque_nm[0] / held_nm;
    assert!((left - 0.5).abs() < 0.03, "{left}");
    let _ = fade_out(&mut rig);
    assert!(is_zero(&rig.command));
}

#[test]
fn brakes_hold_when_outputs_are_withdrawn_if_they_are_to_hold_but_not_in_a_stop() {
    let mut rig = Rig::running(holding());
    with_mode(&mut rig, Allocation::MotorAndBrake);
    rig.steps(200);
    let held_nm = rig.command.brake_torque_nm;
    assert!(held_nm[0] > 0.5);
    ask(&mut rig, Event::Disable);
    rig.steps(500);
    assert_eq!(rig.command.brake_torque_nm, held_nm);
    assert_eq!(rig.command.motor_torque_nm, [0.0; 3]);
    assert!(rig.command.enable);
    ask(&mut rig, Event::EstopEngage);
    assert!(is_zero(&rig.step()));
}

#[test]
fn device_that_holds_nothing_switches_off() {
    let mut rig = Rig::pressing(holding(), 0.001);
    rig.hand(V3::zeros());
    rig.steps(5);
    assert_eq!(rig.command.brake_torque_nm, [0.0; 3]);
    ask(&mut rig, Event::Disable);
    let _ = fade_out(&mut rig);
    assert!(is_zero(&rig.command));
}

#[test]
fn withdrawal_ends_also_where_the_force_does_not_fall() {
    let mut model = hhd();
    model.limits.tip_slew_n_per_s = 1.0;
    let mut rig = Rig::running(model);
    rig.wall_at(0.002, 0.0);
    rig.steps(600);
    let force_n = tip_force_n(&rig.record).norm();
    assert!(force_n > 0.3 && force_n < 0.9, "{force_n}");
    ask(&mut rig, Event::Disable);
    rig.steps(150);
    assert!(rig.command.enable);
    rig.steps(60);
    assert!(is_zero(&rig.command));
}
