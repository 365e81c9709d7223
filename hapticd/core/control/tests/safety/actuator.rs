//! The motor model: volts and torque, settling, currents.

use crate::models::{hhd, phantom, spring_drive, torque_drive};
use hapticd_control::actuator::{
    back_emf_v, settle, spring_retention, torque_retention, Motors, Supply,
};
use hapticd_control::io::Command;
use hapticd_control::linear::V3;

const PERIOD_S: f64 = 1e-3;

fn near(a: V3, b: V3) -> bool {
    (a - b).norm() < 1e-9 * (1.0 + b.norm())
}

#[test]
fn residual_circuit_settles_with_l_over_dr() {
    let dr = V3::new(0.109, 0.2, 0.4);
    let keep = spring_retention(&spring_drive(), &dr, PERIOD_S);
    for i in 0..3 {
        let expected = (-1e-3 * dr[i] / 0.000_238).exp();
        assert!((keep[i] - expected).abs() < 1e-12);
    }
}

#[test]
fn torque_lag_settles_with_its_time() {
    let mut drive = torque_drive();
    let keep = torque_retention(&drive, PERIOD_S);
    assert!((keep[0] - (-2.0_f64).exp()).abs() < 1e-12);
    drive.lag_s = 0.0;
    assert_eq!(torque_retention(&drive, PERIOD_S), V3::zeros());
}

#[test]
fn settling_goes_from_the_present_torque_to_the_commanded_one() {
    let retain = V3::new(1.0, 0.25, 0.0);
    let settled = settle(&V3::repeat(4.0), &V3::repeat(8.0), &retain);
    assert_eq!(settled, V3::new(4.0, 7.0, 8.0));
}

#[test]
fn back_emf_is_of_the_motor_side() {
    let emf_v = back_emf_v(&spring_drive(), &V3::new(1.0, -2.0, 0.5));
    let expected = V3::new(7.67, -14.0, 3.5) * 0.0234;
    assert!(near(emf_v, expected));
}

#[test]
fn voltage_is_clipped_to_the_supply_on_either_side() {
    let supply = Supply {
        emf_v: V3::new(1.0, -1.0, 0.0),
        v_per_nm: V3::new(2.0, 2.0, 2.0),
        max_v: V3::repeat(10.0),
    };
    let inside = supply.voltage_v(&V3::new(3.0, 3.0, -4.0));
    assert_eq!(inside, V3::new(7.0, 5.0, -8.0));
    let clipped = supply.voltage_v(&V3::new(5.0, -5.0, 5.0));
    assert_eq!(clipped, V3::new(10.0, -10.0, 10.0));
}

#[test]
fn spring_drive_reaches_the_torque_its_volts_were_made_for() {
    let mut motors = Motors::new(&phantom().drive, PERIOD_S);
    let (torque_nm, qd) = (V3::new(0.1, -0.05, 0.02), V3::new(1.0, 2.0, -1.0));
    let supply = motors.supply(&qd).expect("a spring drive has a supply");
    let command = Command {
        enable: true,
        motor_v: supply.voltage_v(&torque_nm).into(),
        ..Command::default()
    };
    motors.step(&command, &qd, true, None);
    let first = motors.torque_nm();
    let share = 1.0 - (-1e-3 * 0.109 / 0.000_238_f64).exp();
    assert!(near(first, share * torque_nm), "{first}");
    for _ in 0..50 {
        motors.step(&command, &qd, true, None);
    }
    assert!((motors.torque_nm() - torque_nm).norm() < 1e-4);
    let expected_a = torque_nm.component_div(&(V3::new(7.67, 7.0, 7.0) * 0.0234));
    assert!((motors.current_a() - expected_a).norm() < 1e-2);
}

#[test]
fn torque_drive_reaches_the_torque_asked_for() {
    let mut motors = Motors::new(&hhd().drive, PERIOD_S);
    let command = Command {
        enable: true,
        motor_torque_nm: [5.0, -3.0, 0.0],
        ..Command::default()
    };
    motors.step(&command, &V3::zeros(), true, None);
    let expected = V3::new(5.0, -3.0, 0.0) * (1.0 - (-2.0_f64).exp());
    assert!(near(motors.torque_nm(), expected));
    assert!(motors.supply(&V3::zeros()).is_none());
    assert_eq!(motors.current_a(), V3::zeros());
    assert_eq!(motors.winding_c(), V3::zeros());
    assert_eq!(motors.limit_nm(), V3::new(22.2, 22.2, 0.0));
    assert!(motors.budget().used()[0] > 0.0);
}

#[test]
fn outputs_that_are_not_driven_give_nothing() {
    let mut motors = Motors::new(&hhd().drive, PERIOD_S);
    let command = Command {
        enable: true,
        motor_torque_nm: [5.0, 5.0, 0.0],
        ..Command::default()
    };
    motors.step(&command, &V3::zeros(), true, None);
    motors.step(&command, &V3::zeros(), false, None);
    assert_eq!(motors.torque_nm(), V3::zeros());
}

#[test]
fn measured_currents_heat_and_use_the_budget() {
    let mut motors = Motors::new(&phantom().drive, PERIOD_S);
    let measured = V3::new(5.0, 0.0, 0.0);
    for _ in 0..1000 {
        motors.step(&Command::default(), &V3::zeros(), false, Some(measured));
    }
    assert_eq!(motors.current_a(), measured);
    assert!(motors.winding_c()[0] > 30.0);
    assert_eq!(motors.winding_c()[1], 25.0);
    assert!(motors.budget().used()[0] > 0.2);
    let limit_nm = motors.limit_nm();
    assert!((limit_nm[0] - 7.5 * 7.67 * 0.0234).abs() < 1e-9);
    assert!(!motors.hot());
}

#[test]
fn overdrawn_budget_or_hot_winding_is_hot() {
    let mut overdrawn = Motors::new(&phantom().drive, PERIOD_S);
    for _ in 0..2000 {
        overdrawn.step(
            &Command::default(),
            &V3::zeros(),
            false,
            Some(V3::new(7.5, 0.0, 0.0)),
        );
    }
    assert!(overdrawn.winding_c().max() < 100.0);
    assert!(overdrawn.hot());
    let mut hot = Motors::new(&phantom().drive, 1.0);
    hot.step(
        &Command::default(),
        &V3::zeros(),
        false,
        Some(V3::new(60.0, 0.0, 0.0)),
    );
    assert!(hot.hot());
}
