//! Every limit of the bounding layer on its own.

use crate::models::{hhd, phantom};
use hapticd_control::actuator::Supply;
use hapticd_control::bound::{
    bound_brake, bound_motor, dissipates, finite, joint_share, singularity_fade, slew_share,
    tip_share, voltage_share, Bounds, BrakeAsk,
};
use hapticd_control::linear::{M3, V3};
use hapticd_control::model::LimitModel;
use hapticd_control::record::limit;
use proptest::prelude::*;

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

/// 10 N at the tip per N·m, 5 N·m at most, 30 N, 1000 N/s at 1 kHz, no lag, at rest.
fn bounds<'a>(limits: &'a LimitModel, jacobian_inverse: &'a M3) -> Bounds<'a> {
    Bounds {
        limits,
        period_s: 1e-3,
        fade: 1.0,
        jacobian_inverse,
        peak_nm: V3::repeat(5.0),
        present_nm: V3::zeros(),
        retain: V3::zeros(),
        supply: None,
    }
}

fn limits() -> LimitModel {
    LimitModel {
        tip_force_n: 30.0,
        tip_slew_n_per_s: 1000.0,
        ..hhd().limits
    }
}

/// The same with a slew limit that never acts.
fn quick() -> LimitModel {
    LimitModel {
        tip_slew_n_per_s: 1e9,
        ..limits()
    }
}

fn lever() -> M3 {
    M3::from_diagonal_element(10.0)
}

fn supply() -> Supply {
    Supply {
        emf_v: V3::new(4.0, -4.0, 0.0),
        v_per_nm: V3::repeat(10.0),
        max_v: V3::repeat(24.0),
    }
}

#[test]
fn one_value_that_is_not_finite_is_enough() {
    assert!(finite(&V3::new(1.0, -1e300, 0.0)));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!finite(&V3::new(0.0, bad, 0.0)));
    }
}

#[test]
fn singularity_fades_between_half_the_margin_and_the_margin() {
    assert_eq!(singularity_fade(0.31, 0.3), 1.0);
    assert_eq!(singularity_fade(0.15, 0.3), 0.0);
    assert_eq!(singularity_fade(0.0, 0.3), 0.0);
    assert!(near(singularity_fade(0.225, 0.3), 0.5));
    assert!(near(singularity_fade(0.1875, 0.3), 0.15625));
}

#[test]
fn joint_share_is_that_of_the_worst_joint() {
    let peak = V3::new(4.0, 2.0, 0.0);
    assert_eq!(joint_share(&V3::new(-4.0, 2.0, 0.0), &peak), 1.0);
    assert_eq!(joint_share(&V3::new(8.0, -8.0, 0.0), &peak), 0.25);
    assert_eq!(joint_share(&V3::new(-8.0, 1.0, 0.0), &peak), 0.5);
}

#[test]
fn tip_share_is_of_the_norm_of_the_force() {
    let torque = V3::new(3.0, 4.0, 0.0);
    assert_eq!(tip_share(&torque, &lever(), 50.0), 1.0);
    assert_eq!(tip_share(&torque, &lever(), 25.0), 0.5);
}

#[test]
fn tip_share_takes_the_transpose_of_the_inverse() {
    let inverse = M3::new(0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    assert_eq!(tip_share(&V3::new(5.0, 0.0, 0.0), &inverse, 5.0), 0.5);
    assert_eq!(tip_share(&V3::new(0.0, 5.0, 0.0), &inverse, 5.0), 1.0);
}

#[test]
fn voltage_share_leaves_room_for_the_back_emf() {
    assert_eq!(voltage_share(&V3::new(2.0, -2.0, 2.4), &supply()), 1.0);
    assert_eq!(voltage_share(&V3::new(4.0, 0.0, 0.0), &supply()), 0.5);
    assert_eq!(voltage_share(&V3::new(-5.6, 0.0, 0.0), &supply()), 0.5);
    assert_eq!(voltage_share(&V3::new(0.0, -4.0, 0.0), &supply()), 0.5);
    assert_eq!(voltage_share(&V3::new(0.0, 5.6, 0.0), &supply()), 0.5);
}

#[test]
fn voltage_share_is_zero_where_the_back_emf_fills_the_supply() {
    let full = Supply {
        emf_v: V3::new(30.0, 0.0, 0.0),
        ..supply()
    };
    assert_eq!(voltage_share(&V3::new(1.0, 0.0, 0.0), &full), 0.0);
    assert_eq!(voltage_share(&V3::new(-1.0, 0.0, 0.0), &full), 1.0);
}

#[test]
fn voltage_share_ignores_an_axis_without_a_supply() {
    let planar = Supply {
        emf_v: V3::new(4.0, -4.0, 0.0),
        v_per_nm: V3::new(10.0, 10.0, 0.0),
        max_v: V3::new(24.0, 24.0, 0.0),
    };
    assert_eq!(voltage_share(&V3::new(1.0, 1.0, 0.0), &planar), 1.0);
}

#[test]
fn slew_share_counts_only_what_the_motor_gives_within_the_period() {
    let (limits, lever) = (limits(), lever());
    let prompt = bounds(&limits, &lever);
    assert!(near(slew_share(&V3::new(0.4, 0.0, 0.0), &prompt), 0.25));
    let lagging = Bounds {
        retain: V3::repeat(0.75),
        ..prompt
    };
    assert_eq!(slew_share(&V3::new(0.4, 0.0, 0.0), &lagging), 1.0);
    assert!(near(slew_share(&V3::new(0.8, 0.0, 0.0), &lagging), 0.5));
    let slower = Bounds {
        period_s: 0.5e-3,
        ..prompt
    };
    assert!(near(slew_share(&V3::new(0.4, 0.0, 0.0), &slower), 0.125));
}

#[test]
fn torque_inside_every_limit_is_left_alone() {
    let (limits, lever) = (quick(), lever());
    let asked = V3::new(1.0, -2.0, 0.5);
    let bounded = bound_motor(&asked, &bounds(&limits, &lever));
    assert!((bounded.torque_nm - asked).norm() < 1e-12);
    assert_eq!(bounded.acted, 0);
}

#[test]
fn torque_that_is_not_finite_is_nothing_and_says_so() {
    let (limits, lever) = (quick(), lever());
    let bounded = bound_motor(&V3::new(1.0, f64::NAN, 0.0), &bounds(&limits, &lever));
    assert_eq!(bounded.torque_nm, V3::zeros());
    assert_eq!(bounded.acted, limit::NON_FINITE);
}

#[test]
fn fade_scales_before_the_limits() {
    let (limits, lever) = (quick(), lever());
    let faded = Bounds {
        fade: 0.25,
        ..bounds(&limits, &lever)
    };
    let bounded = bound_motor(&V3::new(8.0, 0.0, 0.0), &faded);
    assert!((bounded.torque_nm - V3::new(2.0, 0.0, 0.0)).norm() < 1e-12);
    assert_eq!(bounded.acted, 0);
}

#[test]
fn each_limit_scales_the_whole_torque_and_names_itself() {
    let (limits, lever) = (quick(), lever());
    let base = bounds(&limits, &lever);
    let asked = V3::new(2.0, 1.0, 0.0);
    let tight_joint = Bounds {
        peak_nm: V3::repeat(1.0),
        ..base
    };
    let weak = LimitModel {
        tip_force_n: 5.0_f64.sqrt() * 5.0,
        ..limits
    };
    let tight_tip = Bounds {
        limits: &weak,
        ..base
    };
    let tight_volts = Bounds {
        supply: Some(Supply {
            max_v: V3::repeat(14.0),
            ..supply()
        }),
        ..base
    };
    for (bounds, bit) in [
        (tight_joint, limit::MOTOR_TORQUE),
        (tight_tip, limit::TIP_FORCE),
        (tight_volts, limit::VOLTAGE),
    ] {
        let bounded = bound_motor(&asked, &bounds);
        assert!(
            (bounded.torque_nm - 0.5 * asked).norm() < 1e-9,
            "{bit} {}",
            bounded.torque_nm
        );
        assert_eq!(bounded.acted, bit);
    }
}

#[test]
fn smallest_share_wins() {
    let (limits, lever) = (quick(), lever());
    let tight = Bounds {
        peak_nm: V3::repeat(2.0),
        supply: Some(Supply {
            max_v: V3::repeat(14.0),
            ..supply()
        }),
        ..bounds(&limits, &lever)
    };
    let bounded = bound_motor(&V3::new(4.0, 0.0, 0.0), &tight);
    assert!(near(bounded.torque_nm[0], 1.0), "{}", bounded.torque_nm);
    let all = limit::MOTOR_TORQUE | limit::TIP_FORCE | limit::VOLTAGE;
    assert_eq!(bounded.acted, all);
}

#[test]
fn slew_goes_part_of_the_way_from_the_present_torque() {
    let (limits, lever) = (limits(), lever());
    let present = V3::new(1.0, 0.5, 0.0);
    let moving = Bounds {
        present_nm: present,
        ..bounds(&limits, &lever)
    };
    let asked = V3::new(1.3, 0.9, 0.0);
    let bounded = bound_motor(&asked, &moving);
    let expected = present + 0.2 * (asked - present);
    assert!((bounded.torque_nm - expected).norm() < 1e-12);
    assert_eq!(bounded.acted, limit::SLEW);
}

#[test]
fn limits_have_the_last_word_over_the_slew() {
    let (limits, lever) = (limits(), lever());
    let outside = Bounds {
        present_nm: V3::new(4.0, 0.0, 0.0),
        ..bounds(&limits, &lever)
    };
    let bounded = bound_motor(&V3::zeros(), &outside);
    assert!(near(bounded.torque_nm[0], 3.0), "{}", bounded.torque_nm);
    assert_eq!(bounded.acted, limit::SLEW | limit::TIP_FORCE);
}

#[test]
fn limit_that_acts_before_and_after_the_slew_still_names_itself() {
    let (limits, lever) = (limits(), lever());
    let outside = Bounds {
        present_nm: V3::new(4.0, 0.0, 0.0),
        ..bounds(&limits, &lever)
    };
    let bounded = bound_motor(&V3::new(-4.0, 0.0, 0.0), &outside);
    assert_eq!(bounded.acted, limit::SLEW | limit::TIP_FORCE);
}

#[test]
fn brake_gets_what_is_asked_inside_its_bounds() {
    assert_eq!(bound_brake(&ask()), 3.0);
}

fn ask() -> BrakeAsk {
    BrakeAsk {
        asked_nm: 3.0,
        before_nm: 2.0,
        wanted_nm: 4.0,
        qd: -1.0,
        max_nm: 10.0,
        rise_nm: 2.0,
        omega_off: 0.02,
    }
}

#[test]
fn brake_stays_between_zero_and_its_largest_torque() {
    assert_eq!(
        bound_brake(&BrakeAsk {
            asked_nm: 50.0,
            before_nm: 9.0,
            ..ask()
        }),
        10.0
    );
    assert_eq!(
        bound_brake(&BrakeAsk {
            asked_nm: -3.0,
            ..ask()
        }),
        0.0
    );
    assert_eq!(
        bound_brake(&BrakeAsk {
            asked_nm: f64::NAN,
            ..ask()
        }),
        0.0
    );
}

#[test]
fn brake_rises_slowly_and_lets_go_at_once() {
    assert_eq!(
        bound_brake(&BrakeAsk {
            asked_nm: 8.0,
            ..ask()
        }),
        4.0
    );
    assert_eq!(
        bound_brake(&BrakeAsk {
            asked_nm: 0.5,
            before_nm: 9.0,
            ..ask()
        }),
        0.5
    );
}

#[test]
fn brake_in_the_direction_of_motion_is_released() {
    assert_eq!(bound_brake(&BrakeAsk { qd: 1.0, ..ask() }), 0.0);
    assert_eq!(
        bound_brake(&BrakeAsk {
            wanted_nm: -4.0,
            ..ask()
        }),
        0.0
    );
}

#[test]
fn at_rest_the_sense_of_motion_is_noise() {
    assert!(dissipates(4.0, 0.02, 0.02));
    assert!(dissipates(-4.0, 0.01, 0.02));
    assert!(!dissipates(4.0, 0.021, 0.02));
    assert!(dissipates(4.0, -0.021, 0.02));
    assert!(!dissipates(0.0, 0.021, 0.02));
}

fn vector(size: f64) -> impl Strategy<Value = V3> {
    prop::array::uniform3(-size..size).prop_map(V3::from)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// From a present torque inside the limits, every law holds at once: nothing is excused.
    #[test]
    fn from_inside_the_limits_slew_and_limits_hold_together(
        asked in vector(30.0),
        direction in vector(1.0),
        fade in 0.0..=1.0_f64,
        retain in 0.0..1.0_f64,
    ) {
        let limits = LimitModel { tip_slew_n_per_s: 4000.0, ..phantom().limits };
        let jacobian_inverse = M3::new(8.0, 1.0, 0.0, -2.0, 7.0, 1.0, 0.0, 3.0, 6.0);
        let supply = Supply { emf_v: 10.0 * direction, v_per_nm: V3::repeat(9.0), max_v: V3::repeat(24.0) };
        let base = Bounds {
            fade,
            retain: V3::repeat(retain),
            supply: Some(supply),
            ..bounds(&limits, &jacobian_inverse)
        };
        let reach = Bounds { retain: V3::repeat(1.0), ..base };
        let present_nm = bound_motor(&(10.0 * direction), &reach).torque_nm;
        let bounded = bound_motor(&asked, &Bounds { present_nm, ..base });
        let torque_nm = bounded.torque_nm;
        let step_n = (1.0 - retain) * jacobian_inverse.tr_mul(&(torque_nm - present_nm)).norm();
        prop_assert!(step_n <= 4.0 + 1e-9);
        prop_assert!(jacobian_inverse.tr_mul(&torque_nm).norm() <= limits.tip_force_n + 1e-9);
        prop_assert!(torque_nm.amax() <= 5.0 + 1e-9);
        let volts = supply.emf_v + supply.v_per_nm.component_mul(&torque_nm);
        prop_assert!(volts.amax() <= 24.0 + 1e-9);
    }

    /// Scaling as a whole: what the limits leave points where it was asked to.
    #[test]
    fn limits_keep_the_direction(asked in vector(30.0), emf in vector(20.0)) {
        let (limits, lever) = (quick(), lever());
        let tight = Bounds {
            supply: Some(Supply { emf_v: emf, ..supply() }),
            ..bounds(&limits, &lever)
        };
        let torque_nm = bound_motor(&asked, &tight).torque_nm;
        prop_assert!(torque_nm.cross(&asked).norm() < 1e-9 * asked.norm_squared());
        prop_assert!(torque_nm.dot(&asked) >= 0.0);
    }
}
