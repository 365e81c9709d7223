//! Friction by brakes: what they may hold, and which way.

use crate::rubber::{friction, hhd, phantom, surface, wall, Rubber, KINETIC, STATIC};
use hapticd_control::friction::{actuator, FrictionState, Rubbing};
use hapticd_control::linear::V3;
use hapticd_control::scene::{Allocation, FrictionActuator};
use proptest::prelude::*;

fn braked(n: V3, normal_n: f64) -> Rubbing {
    Rubbing {
        friction: friction(FrictionActuator::Brake),
        ..wall(1, n, normal_n)
    }
}

proptest! {
    #[test]
    fn at_rest_brakes_may_hold_the_static_force_against_the_hand(
        (n, t) in surface(), push_n in 1.0..50.0_f64, pull_n in 0.5..40.0_f64,
    ) {
        let mut rubber = Rubber::new(&hhd());
        let found = rubber.step(&V3::zeros(), &[braked(n, 1.0)], Some(&(pull_n * t - push_n * n)));
        prop_assert_eq!(found.state, FrictionState::Stick);
        prop_assert!((found.brake_n + STATIC * push_n * t).norm() < 1e-9 * push_n);
        prop_assert_eq!(found.motor_n, V3::zeros());
    }

    #[test]
    fn in_slip_brakes_may_give_the_kinetic_force_against_the_motion_whatever_the_hand_pulls(
        (n, t) in surface(), push_n in 1.0..50.0_f64, pull_n in -40.0..40.0_f64,
    ) {
        let mut rubber = Rubber::new(&hhd());
        let hand_n = pull_n * t - push_n * n;
        let mut found = rubber.step(&(1e-4 * t), &[braked(n, 1.0)], Some(&hand_n));
        for _ in 0..100 {
            found = rubber.step(&(1e-4 * t), &[braked(n, 1.0)], Some(&hand_n));
        }
        prop_assert_eq!(found.state, FrictionState::Slip);
        prop_assert!((found.brake_n + KINETIC * push_n * t).norm() < 1e-3 * push_n);
    }
}

#[test]
fn count_that_toggles_at_rest_does_not_count_as_slip() {
    let mut rubber = Rubber::new(&hhd());
    let hand_n = V3::new(5.0, -20.0, 0.0);
    for tick in 0..200 {
        let toggle = if tick % 2 == 0 { 9e-6 } else { -9e-6 };
        let found = rubber.step(&(toggle * V3::x()), &[braked(V3::y(), 1.0)], Some(&hand_n));
        assert_eq!(found.state, FrictionState::Stick);
    }
}

#[test]
fn pull_that_ceases_leaves_the_brakes_charged() {
    let mut rubber = Rubber::new(&hhd());
    let walls = [braked(V3::y(), 1.0)];
    rubber.step(&V3::zeros(), &walls, Some(&V3::new(5.0, -20.0, 0.0)));
    let mut found = V3::zeros();
    for _ in 0..50 {
        found = rubber
            .step(&V3::zeros(), &walls, Some(&V3::new(0.0, -20.0, 0.0)))
            .brake_n;
    }
    assert!((found.norm() - STATIC * 20.0).abs() < 1e-6);
}

#[test]
fn friction_that_moves_to_the_brakes_leaves_no_spring_behind() {
    let mut rubber = Rubber::new(&hhd());
    rubber.steps(100, &(1e-6 * V3::x()), &[wall(1, V3::y(), 20.0)]);
    assert!(rubber.friction.energy_j() > 0.0);
    let found = rubber.step(&V3::zeros(), &[braked(V3::y(), 20.0)], None);
    assert_eq!(found.motor_n, V3::zeros());
    assert_eq!(rubber.friction.energy_j(), 0.0);
}

#[test]
fn brakes_rub_where_there_are_any_unless_wall_or_scene_rules_them_out() {
    use Allocation::{BrakeOnly, MotorAndBrake, MotorOnly};
    use FrictionActuator::{Auto, Brake, Motor};
    let cases = [
        (Auto, true, MotorAndBrake, Brake),
        (Motor, true, MotorAndBrake, Motor),
        (Brake, true, MotorAndBrake, Brake),
        (Auto, true, MotorOnly, Motor),
        (Brake, true, MotorOnly, Motor),
        (Auto, true, BrakeOnly, Brake),
        (Motor, true, BrakeOnly, Brake),
        (Auto, phantom().brakes.is_some(), MotorAndBrake, Motor),
        (Brake, phantom().brakes.is_some(), BrakeOnly, Motor),
    ];
    for (asked, brakes, allocation, expected) in cases {
        assert_eq!(actuator(asked, brakes, allocation), expected);
    }
}
