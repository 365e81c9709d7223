//! A wall keeps its anchor while it is edited.

use crate::rubber::{hhd, wall, Rubber, STATIC};
use hapticd_control::linear::V3;

/// Stuck, the anchor stretched to 3 N.
fn stuck() -> Rubber {
    let mut rubber = Rubber::new(&hhd());
    let found = rubber.steps(100, &(1e-6 * V3::x()), &[wall(7, V3::y(), 20.0)]);
    assert!(
        (found.motor_n.norm() - 3.0).abs() < 0.2,
        "{}",
        found.motor_n
    );
    rubber
}

#[test]
fn wall_that_moves_or_is_renumbered_does_not_drag_the_hand() {
    let mut rubber = stuck();
    let before = rubber.step(&V3::zeros(), &[wall(7, V3::y(), 20.0)], None);
    let moved = [wall(3, V3::x(), 1.0), wall(7, V3::y(), 35.0)];
    let after = rubber.step(&V3::zeros(), &moved, None);
    assert!((after.motor_n - before.motor_n).norm() < 1e-9);
}

#[test]
fn wall_that_turns_keeps_what_of_the_stretch_lies_in_it() {
    let mut rubber = stuck();
    let before = rubber.step(&V3::zeros(), &[wall(7, V3::y(), 20.0)], None);
    let turned = V3::new(0.1_f64.sin(), 0.1_f64.cos(), 0.0);
    let after = rubber.step(&V3::zeros(), &[wall(7, turned, 20.0)], None);
    assert!(after.motor_n.dot(&turned).abs() < 1e-9);
    assert!((after.motor_n.norm() - before.motor_n.norm() * 0.1_f64.cos()).abs() < 1e-9);
}

#[test]
fn wall_that_becomes_slippery_lets_the_stretch_go_for_good() {
    let mut rubber = stuck();
    let mut slippery = wall(7, V3::y(), 20.0);
    slippery.friction.static_ = 0.0;
    slippery.friction.kinetic = 0.0;
    assert_eq!(
        rubber.step(&V3::zeros(), &[slippery], None).motor_n,
        V3::zeros()
    );
    let again = rubber.step(&V3::zeros(), &[wall(7, V3::y(), 20.0)], None);
    assert_eq!(again.motor_n, V3::zeros());
}

#[test]
fn another_wall_in_the_same_place_starts_unstretched() {
    let mut rubber = stuck();
    let replaced = rubber.step(&V3::zeros(), &[wall(8, V3::y(), 20.0)], None);
    assert_eq!(replaced.motor_n, V3::zeros());
}

#[test]
fn wall_left_and_met_again_elsewhere_does_not_pull_back() {
    let mut rubber = stuck();
    rubber.steps(100, &(1e-4 * V3::x()), &[]);
    let met = rubber.step(&V3::zeros(), &[wall(7, V3::y(), 20.0)], None);
    assert_eq!(met.motor_n, V3::zeros());
    let held = rubber.steps(1000, &(1e-6 * V3::x()), &[wall(7, V3::y(), 20.0)]);
    assert!(held.motor_n.norm() <= STATIC * 20.0);
}
