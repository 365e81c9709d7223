use crate::models::{hhd, phantom};
use hapticd_control::estimate::{Estimator, JointState};
use hapticd_control::linear::V3;
use proptest::prelude::*;

const TICK_S: f64 = 1e-3;

fn at_rest() -> Estimator {
    let mut estimator = Estimator::new(&phantom());
    estimator.reset(&[0; 3]);
    estimator
}

proptest! {
    #[test]
    fn lost_frames_leave_the_velocity_of_an_even_motion(
        step in prop::array::uniform3(-20..20_i64), frames in 1..6_i64,
    ) {
        let (mut whole, mut lossy) = (at_rest(), at_rest());
        for frame in 1..=frames {
            whole.update(&step.map(|s| s * frame), TICK_S);
        }
        let counts = step.map(|s| s * frames);
        let whole = whole.update(&counts, 0.0);
        let lossy = lossy.update(&counts, TICK_S * frames as f64);
        prop_assert!((whole.qd - lossy.qd).norm() < 1e-9);
        prop_assert_eq!(whole.q, lossy.q);
    }

    #[test]
    fn even_motion_settles_at_its_own_velocity(step in -20..20_i64, tick_s in 1e-4..2e-3) {
        let mut estimator = at_rest();
        let mut state = JointState::default();
        for frame in 1..=200 {
            state = estimator.update(&[0, step * frame, 0], tick_s);
        }
        let expected = step as f64 / phantom().joints.counts_per_rad[1] / tick_s;
        prop_assert!((state.qd.y - expected).abs() < 1e-6 * (1.0 + expected.abs()));
        prop_assert!((state.xd - state.jacobian * state.qd).norm() < 1e-12);
    }
}

#[test]
fn velocity_of_a_sudden_motion_rises_with_lambda() {
    let model = phantom();
    let state = at_rest().update(&[50, 0, 0], TICK_S);
    let full = 50.0 / model.joints.counts_per_rad[0] / TICK_S;
    let rise = 1.0 - (-model.estimator.lambda_rad_per_s * TICK_S).exp();
    assert!((state.qd.x - rise * full).abs() < 1e-12);
}

#[test]
fn first_counts_after_start_are_no_motion() {
    let state = Estimator::new(&phantom()).update(&[4000, -7, 90], TICK_S);
    assert_eq!(state.qd, V3::zeros());
    assert!((state.q.x - 0.8).abs() < 1e-12);
}

#[test]
fn reset_forgets_the_motion_before_it() {
    let mut estimator = at_rest();
    estimator.update(&[100, 100, 100], TICK_S);
    estimator.reset(&[500, 0, 0]);
    assert_eq!(estimator.update(&[500, 0, 0], TICK_S).qd, V3::zeros());
}

#[test]
fn tick_without_time_keeps_the_velocity() {
    let mut estimator = at_rest();
    let before = estimator.update(&[10, 0, 0], TICK_S).qd;
    for dt_s in [0.0, -1.0, f64::NAN] {
        assert_eq!(estimator.update(&[10, 0, 0], dt_s).qd, before);
    }
}

#[test]
fn counts_near_the_end_of_their_range_do_not_overflow() {
    let mut estimator = at_rest();
    estimator.reset(&[i64::MIN; 3]);
    let state = estimator.update(&[i64::MAX; 3], TICK_S);
    assert!(state.qd.iter().all(|velocity| velocity.is_finite()));
}

#[test]
fn unused_axis_stays_at_zero() {
    let mut estimator = Estimator::new(&hhd());
    estimator.update(&[0, 0, 0], TICK_S);
    let state = estimator.update(&[5, 5, 999], TICK_S);
    assert_eq!((state.q.z, state.qd.z, state.x.z), (0.0, 0.0, 0.0));
}

#[test]
fn singular_pose_has_a_zero_inverse_jacobian() {
    let folded = JointState::at(&hhd().kinematics, V3::new(1.0, 1.0, 0.0), V3::zeros());
    assert_eq!(folded.jacobian_inverse.norm(), 0.0);
    assert_eq!(folded.singularity_margin, 0.0);
}
