//! How large friction is, and where it points.

use crate::rubber::{device, path, surface, wall, Rubber, KINETIC, STATIC};
use hapticd_control::friction::FrictionState;
use hapticd_control::linear::V3;
use proptest::prelude::*;

proptest! {
    #[test]
    fn force_stays_in_the_static_cone_and_in_slip_in_the_kinetic_one(
        model in device(), (n, _) in surface(), path in path(),
    ) {
        let mut rubber = Rubber::new(&model);
        for (step_m, normal_n) in path {
            let found = rubber.step(&step_m, &[wall(1, n, normal_n)], None);
            let coefficient = match found.state {
                FrictionState::None => 0.0,
                FrictionState::Stick => STATIC,
                FrictionState::Slip => KINETIC,
            };
            let (force_n, largest_n) = (found.motor_n.norm(), coefficient * normal_n);
            prop_assert!(force_n <= largest_n * (1.0 + 1e-9), "{force_n} N of {largest_n} N");
            prop_assert!(found.motor_n.dot(&n).abs() < 1e-9);
            prop_assert_eq!(found.brake_n, V3::zeros());
        }
    }

    #[test]
    fn steady_slip_meets_the_kinetic_force_against_the_motion(
        model in device(), (n, t) in surface(), normal_n in 1.0..50.0_f64, speed in 0.02..0.5_f64,
    ) {
        let mut rubber = Rubber::new(&model);
        let ticks = (0.1 / speed / 1e-3) as usize;
        let found = rubber.steps(ticks, &(speed * 1e-3 * t), &[wall(1, n, normal_n)]);
        prop_assert_eq!(found.state, FrictionState::Slip);
        let expected_n = -KINETIC * normal_n * t;
        prop_assert!((found.motor_n - expected_n).norm() < 1e-6 * normal_n, "{}", found.motor_n);
    }

    #[test]
    fn slip_that_turns_round_meets_the_kinetic_force_the_other_way(
        model in device(), (n, t) in surface(), normal_n in 1.0..20.0_f64, angle in 0.5..3.1_f64,
    ) {
        let mut rubber = Rubber::new(&model);
        let walls = [wall(1, n, normal_n)];
        rubber.steps(500, &(1e-4 * t), &walls);
        let turned = angle.cos() * t + angle.sin() * n.cross(&t);
        let found = rubber.steps(2000, &(1e-4 * turned), &walls);
        let expected_n = -KINETIC * normal_n * turned;
        prop_assert!((found.motor_n - expected_n).norm() < 1e-3 * normal_n, "{}", found.motor_n);
    }

    #[test]
    fn no_normal_force_no_friction(model in device(), (n, _) in surface(), path in path()) {
        let mut rubber = Rubber::new(&model);
        for (step_m, _) in path {
            let found = rubber.step(&step_m, &[wall(1, n, 0.0)], None);
            prop_assert_eq!(found.motor_n, V3::zeros());
            prop_assert_eq!(found.state, FrictionState::None);
        }
    }

    #[test]
    fn pull_rises_to_the_static_force_and_drops_to_the_kinetic_one(
        model in device(), (n, t) in surface(), normal_n in 2.0..40.0_f64,
    ) {
        let mut rubber = Rubber::new(&model);
        let walls = [wall(1, n, normal_n)];
        let mut before_n = 0.0;
        let mut found = rubber.step(&V3::zeros(), &walls, None);
        while found.state == FrictionState::Stick {
            before_n = found.motor_n.norm();
            found = rubber.step(&(2e-6 * t), &walls, None);
        }
        prop_assert!(before_n > 0.97 * STATIC * normal_n, "{before_n}");
        prop_assert!((found.motor_n.norm() - KINETIC * normal_n).abs() < 1e-6 * normal_n);
    }
}

#[test]
fn slow_slip_sticks_again() {
    let mut rubber = Rubber::new(&crate::rubber::hhd());
    let walls = [wall(1, V3::y(), 20.0)];
    let found = rubber.steps(200, &(5e-5 * V3::x()), &walls);
    assert_eq!(found.state, FrictionState::Slip);
    let found = rubber.steps(100, &(1e-6 * V3::x()), &walls);
    assert_eq!(found.state, FrictionState::Stick);
    assert!(found.motor_n.norm() <= STATIC * 20.0);
}
