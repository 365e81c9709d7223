//! The I²t budget.

use crate::models::phantom;
use crate::rig::Rig;
use hapticd_control::budget::{Budget, Rating};
use hapticd_control::linear::V3;
use hapticd_control::record::limit;

const RATING: Rating = Rating {
    peak: [6.0, 6.0, 0.0],
    continuous: [2.0, 2.0, 0.0],
    peak_time_s: 1.5,
};
const PERIOD_S: f64 = 1e-3;

fn after(load: V3, seconds: f64) -> Budget {
    let mut budget = Budget::new(RATING, PERIOD_S);
    for _ in 0..(seconds / PERIOD_S).round() as usize {
        budget.step(&load);
    }
    budget
}

#[test]
fn peak_lasts_its_time_from_cold() {
    let used = after(V3::new(6.0, 0.0, 0.0), 1.5).used();
    assert!((used[0] - 1.0).abs() < 1e-9, "{used}");
    assert_eq!((used[1], used[2]), (0.0, 0.0));
}

#[test]
fn continuous_load_lasts_for_ever() {
    let budget = after(V3::new(-2.0, 2.0, 0.0), 400.0);
    assert!((budget.used()[0] - 1.0).abs() < 1e-6);
    assert!(!budget.overdrawn());
    assert!((budget.limit()[0] - 2.0).abs() < 1e-4);
}

#[test]
fn budget_recovers_at_rest() {
    let mut budget = after(V3::new(6.0, 0.0, 0.0), 1.5);
    for _ in 0..60_000 {
        budget.step(&V3::zeros());
    }
    assert!(budget.used()[0] < 0.05);
}

/// A budget under peak load until `share` is used.
fn used_up_to(share: f64) -> Budget {
    let mut budget = Budget::new(RATING, PERIOD_S);
    for _ in 0..2000 {
        if budget.used()[0] < share {
            budget.step(&V3::new(6.0, 0.0, 0.0));
        }
    }
    budget
}

#[test]
fn limit_folds_from_peak_to_continuous_over_the_last_fifth() {
    let fresh = Budget::new(RATING, PERIOD_S);
    assert_eq!(fresh.limit(), V3::new(6.0, 6.0, 0.0));
    assert!(!fresh.folding());
    let budget = used_up_to(0.9);
    assert!((budget.limit()[0] - 4.0).abs() < 0.05, "{}", budget.limit());
    assert_eq!(budget.limit()[1], 6.0);
    assert!(budget.folding());
}

#[test]
fn limit_does_not_fold_before_its_last_fifth() {
    let budget = used_up_to(0.78);
    assert!(budget.used()[0] > 0.7);
    assert_eq!(budget.limit()[0], 6.0);
}

#[test]
fn limit_never_falls_below_continuous() {
    let budget = after(V3::new(12.0, 0.0, 0.0), 1.0);
    assert!(budget.used()[0] > 1.2);
    assert_eq!(budget.limit()[0], 2.0);
    assert!(budget.overdrawn());
}

#[test]
fn obeying_the_limit_keeps_the_budget() {
    let mut budget = Budget::new(RATING, PERIOD_S);
    for _ in 0..100_000 {
        let load = budget.limit();
        budget.step(&load);
        assert!(budget.used().max() <= 1.0);
    }
}

#[test]
fn long_push_is_folded_back_to_continuous_without_a_fault() {
    let mut rig = Rig::pressing(phantom(), 0.004);
    let strong_n = V3::from(rig.record.tip_force_n).norm();
    for _ in 0..8000 {
        rig.step();
    }
    assert_eq!(rig.record.faults, 0);
    assert_ne!(rig.record.limits & limit::THERMAL, 0);
    assert!(V3::from(rig.record.motor_i2t).max() <= 1.0);
    assert!(V3::from(rig.record.tip_force_n).norm() < 0.5 * strong_n);
    assert!(V3::from(rig.record.motor_current_a).amax() >= 1.2);
}
