//! The brake model: dead time, hysteresis, lag and reaction.

use crate::models::brakes;
use hapticd_control::brake::Brakes;
use hapticd_control::linear::V3;
use hapticd_control::model::BrakeModel;

const PERIOD_S: f64 = 1e-3;

fn after(model: &BrakeModel, asked_nm: &[(f64, usize)]) -> Brakes {
    let mut brakes = Brakes::new(model, PERIOD_S);
    for (nm, ticks) in asked_nm {
        for _ in 0..*ticks {
            brakes.step(&V3::new(*nm, 0.0, 0.0));
        }
    }
    brakes
}

fn plain() -> BrakeModel {
    BrakeModel {
        hysteresis: 0.0,
        ..brakes()
    }
}

#[test]
fn torque_follows_with_its_lag() {
    let torque_nm = after(&plain(), &[(8.0, 50)]).torque_nm();
    let expected = 8.0 * (1.0 - (-1.0_f64).exp());
    assert!((torque_nm[0] - expected).abs() < 1e-9, "{torque_nm}");
    assert_eq!((torque_nm[1], torque_nm[2]), (0.0, 0.0));
}

#[test]
fn without_lag_torque_follows_at_once() {
    let model = BrakeModel {
        lag_s: 0.0,
        ..plain()
    };
    assert_eq!(after(&model, &[(8.0, 1)]).torque_nm()[0], 8.0);
}

#[test]
fn nothing_happens_within_the_dead_time() {
    let model = BrakeModel {
        dead_time_s: 0.058,
        lag_s: 0.0,
        ..plain()
    };
    assert_eq!(after(&model, &[(8.0, 58)]).torque_nm()[0], 0.0);
    assert_eq!(after(&model, &[(8.0, 59)]).torque_nm()[0], 8.0);
    assert_eq!(after(&model, &[(8.0, 59), (0.0, 58)]).torque_nm()[0], 8.0);
    assert_eq!(after(&model, &[(8.0, 59), (0.0, 59)]).torque_nm()[0], 0.0);
}

#[test]
fn hysteresis_lags_behind_on_either_branch() {
    let model = BrakeModel {
        lag_s: 0.0,
        ..brakes()
    };
    let up = after(&model, &[(5.0, 1)]).torque_nm()[0];
    let down = after(&model, &[(10.0, 1), (5.0, 1)]).torque_nm()[0];
    assert!((up - 4.5).abs() < 1e-12, "{up}");
    assert!((down - 5.5).abs() < 1e-12, "{down}");
    let residual = after(&model, &[(10.0, 1), (0.0, 1)]).torque_nm()[0];
    assert!((residual - 0.5).abs() < 1e-12, "{residual}");
}

#[test]
fn torque_is_never_negative() {
    let model = BrakeModel {
        lag_s: 0.0,
        ..brakes()
    };
    assert_eq!(after(&model, &[(0.2, 3)]).torque_nm()[0], 0.0);
}

#[test]
fn capacity_holds_the_drag_too() {
    let capacity_nm = after(&plain(), &[]).capacity_nm();
    assert_eq!(capacity_nm, V3::new(0.4, 0.4, 0.0));
}

#[test]
fn moving_brake_acts_against_the_motion_with_all_it_has() {
    let brakes = after(&plain(), &[(8.0, 500)]);
    let capacity_nm = brakes.capacity_nm();
    let reaction = brakes.reaction_nm(&V3::new(0.5, -0.5, 0.0), &V3::new(1.0, 1.0, 0.0));
    assert_eq!(reaction, V3::new(-capacity_nm[0], capacity_nm[1], 0.0));
}

#[test]
fn resting_brake_holds_what_pushes_as_far_as_it_can() {
    let brakes = after(&plain(), &[(8.0, 500)]);
    let held = brakes.reaction_nm(&V3::zeros(), &V3::new(3.0, -2.0, 0.0));
    assert_eq!(held, V3::new(-3.0, 0.4, 0.0));
    let crawling = V3::new(0.019, -0.019, 0.0);
    assert_eq!(
        brakes.reaction_nm(&crawling, &V3::new(3.0, -2.0, 0.0)),
        held
    );
}
