//! Where the normal force comes from.

use crate::rubber::{hhd, surface, wall, Rubber, KINETIC, PERIOD_S};
use hapticd_control::friction::Rubbing;
use hapticd_control::linear::V3;
use hapticd_control::scene::Friction;
use proptest::prelude::*;

/// Force of a slip under a steady push of the hand, N.
fn slipping(walls: &[Rubbing], hand_n: &V3, t: &V3) -> V3 {
    let mut rubber = Rubber::new(&hhd());
    let mut found = V3::zeros();
    for _ in 0..400 {
        found = rubber.step(&(1e-4 * t), walls, Some(hand_n)).motor_n;
    }
    found
}

proptest! {
    #[test]
    fn measured_force_decides_over_the_rendered_one(
        (n, t) in surface(), push_n in 0.0..50.0_f64, pull_n in -20.0..20.0_f64, rendered_n in 0.0..60.0_f64,
    ) {
        let hand_n = -push_n * n + pull_n * t;
        let found_n = slipping(&[wall(1, n, rendered_n)], &hand_n, &t);
        prop_assert!((found_n + KINETIC * push_n * t).norm() < 1e-6);
    }

    #[test]
    fn hand_that_pulls_off_meets_no_friction((n, t) in surface(), off_n in 0.1..50.0_f64) {
        let found_n = slipping(&[wall(1, n, 5.0)], &(off_n * n), &t);
        prop_assert_eq!(found_n, V3::zeros());
    }

    #[test]
    fn walls_on_the_same_spot_share_one_push((n, t) in surface(), push_n in 1.0..50.0_f64) {
        let twins = [wall(1, n, 3.0), wall(2, n, 9.0)];
        let found_n = slipping(&twins, &(-push_n * n), &t);
        prop_assert!((found_n + KINETIC * push_n * t).norm() < 1e-6);
    }

    #[test]
    fn push_into_a_slippery_neighbour_does_not_rub(
        (n, t) in surface(), push_n in 1.0..50.0_f64, side_n in 1.0..50.0_f64,
    ) {
        let slippery = Rubbing { friction: Friction::default(), ..wall(2, t, 1.0) };
        let hand_n = -push_n * n - side_n * t;
        let along = n.cross(&t);
        let found_n = slipping(&[wall(1, n, 1.0), slippery], &hand_n, &along);
        prop_assert!((found_n + KINETIC * push_n * along).norm() < 1e-3 * push_n);
    }
}

#[test]
fn measured_force_is_low_passed_at_100_hz() {
    let walls = [wall(1, V3::y(), 0.0)];
    let mut rubber = Rubber::new(&hhd());
    for _ in 0..400 {
        rubber.step(&(1e-4 * V3::x()), &walls, Some(&V3::new(0.0, -10.0, 0.0)));
    }
    let stepped = V3::new(0.0, -20.0, 0.0);
    let found = rubber.step(&(1e-4 * V3::x()), &walls, Some(&stepped));
    let share = 1.0 - (-core::f64::consts::TAU * 100.0 * PERIOD_S).exp();
    // The stretch grows with the tip alone: one step of 0.1 mm on half the coupling's stiffness.
    assert!(found.motor_n.norm() <= KINETIC * (10.0 + 10.0 * share) + 1e-9);
    for _ in 0..50 {
        rubber.step(&(1e-4 * V3::x()), &walls, Some(&stepped));
    }
    let found = rubber.step(&(1e-4 * V3::x()), &walls, Some(&stepped));
    assert!((found.motor_n.norm() - KINETIC * 20.0).abs() < 1e-6);
}

#[test]
fn walls_past_the_memory_are_slippery_and_the_others_rub_on() {
    let walls: Vec<Rubbing> = (0..40).map(|key| wall(key, V3::y(), 1.0)).collect();
    let mut rubber = Rubber::new(&hhd());
    let found = rubber.steps(400, &(1e-4 * V3::x()), &walls);
    assert!((found.motor_n.norm() - 16.0 * KINETIC).abs() < 1e-6);
}
