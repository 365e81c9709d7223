//! The split between motors and brakes.

use crate::models::brakes;
use hapticd_control::allocate::{lone_brake_nm, releasing, usable, Allocator, Load};
use hapticd_control::linear::{M3, V3};
use hapticd_control::release::SHARE;
use hapticd_control::scene::Allocation;
use proptest::prelude::*;

const PERIOD_S: f64 = 1e-3;
const FAST: f64 = 0.1;
const BETWEEN: f64 = 0.04;
const SLOW: f64 = 0.01;

/// A hand that pushes with 5 N·m on each joint against a demand of `torque_nm`.
fn resting(torque_nm: V3) -> Load {
    Load {
        torque_nm,
        force_n: torque_nm,
        force_per_torque: M3::identity(),
        hand_torque_nm: -5.0 * torque_nm.map(f64::signum),
        hand_force_n: -5.0 * torque_nm,
        ..Load::default()
    }
}

fn moving(torque_nm: V3, qd: V3) -> Load {
    Load {
        qd,
        ..resting(torque_nm)
    }
}

fn allocator() -> Allocator {
    Allocator::new(&brakes(), PERIOD_S)
}

#[test]
fn moving_brake_is_usable_where_it_dissipates() {
    for before in [false, true] {
        assert!(usable(&brakes(), before, 3.0, -FAST, 0.0));
        assert!(usable(&brakes(), before, -3.0, FAST, 0.0));
        assert!(!usable(&brakes(), before, 3.0, FAST, -5.0));
        assert!(!usable(&brakes(), before, -3.0, -FAST, 5.0));
        assert!(!usable(&brakes(), before, 0.0, FAST, 0.0));
    }
}

#[test]
fn resting_brake_is_usable_where_the_hand_pushes_against_the_demand() {
    for before in [false, true] {
        assert!(usable(&brakes(), before, 3.0, SLOW, -1.0));
        assert!(usable(&brakes(), before, -3.0, SLOW, 1.0));
        assert!(!usable(&brakes(), before, 3.0, -SLOW, 1.0));
        assert!(
            !usable(&brakes(), before, 3.0, SLOW, -0.1),
            "noise of the sensor"
        );
        assert!(!usable(&brakes(), before, 0.0, SLOW, -1.0));
    }
}

#[test]
fn between_the_thresholds_the_decision_stays() {
    for qd in [BETWEEN, -BETWEEN] {
        assert!(usable(&brakes(), true, 3.0, qd, 0.0));
        assert!(!usable(&brakes(), false, 3.0, qd, -5.0));
    }
}

#[test]
fn thresholds_themselves_belong_to_the_middle() {
    let model = brakes();
    for qd in [model.omega_on_rad_per_s, model.omega_off_rad_per_s] {
        assert!(usable(&model, true, 3.0, qd, 0.0));
        assert!(!usable(&model, false, 3.0, -qd, -1.0));
    }
    assert!(!usable(&model, true, 3.0, SLOW, -model.hand_torque_min_nm));
}

#[test]
fn brakes_release_together_when_the_device_gives_in_to_the_demand() {
    let gives_in = moving(V3::new(4.0, 1.0, 0.0), V3::new(FAST, -FAST, 0.0));
    assert!(releasing(&brakes(), &gives_in));
    let resists = moving(V3::new(1.0, 4.0, 0.0), V3::new(FAST, -FAST, 0.0));
    assert!(!releasing(&brakes(), &resists));
    let sideways = moving(V3::new(1.0, 1.0, 0.0), V3::new(FAST, -FAST, 0.0));
    assert!(!releasing(&brakes(), &sideways));
}

#[test]
fn brakes_release_together_when_the_resting_hand_no_longer_pushes() {
    let pushes = resting(V3::new(3.0, 3.0, 0.0));
    assert!(!releasing(&brakes(), &pushes));
    let pulls = Load {
        hand_force_n: pushes.force_n,
        ..pushes
    };
    assert!(releasing(&brakes(), &pulls));
    let gone = Load {
        hand_force_n: V3::zeros(),
        ..pushes
    };
    assert!(releasing(&brakes(), &gone));
    let creeping = Load {
        qd: V3::repeat(BETWEEN),
        ..pulls
    };
    assert!(!releasing(&brakes(), &creeping));
}

#[test]
fn thresholds_of_releasing_belong_to_the_middle() {
    let model = brakes();
    let pulls = Load {
        hand_force_n: V3::repeat(5.0),
        ..resting(V3::new(3.0, 3.0, 0.0))
    };
    for qd in [model.omega_on_rad_per_s, model.omega_off_rad_per_s] {
        assert!(!releasing(
            &model,
            &Load {
                qd: V3::repeat(qd),
                ..pulls
            }
        ));
    }
}

#[test]
fn motor_alone_takes_everything() {
    let load = moving(V3::new(3.0, -2.0, 0.0), V3::new(-FAST, FAST, 0.0));
    let split = allocator().split(Allocation::MotorOnly, &load);
    assert_eq!(split.motor_nm, load.torque_nm);
    assert_eq!(split.brake_nm, V3::zeros());
    assert_eq!(split.usable, [false; 3]);
}

#[test]
fn brake_takes_what_it_can_and_the_motor_what_the_brake_has_not_built_up() {
    let load = Load {
        brake_nm: V3::new(2.0, 0.5, 0.0),
        ..moving(V3::new(3.0, 14.0, 0.0), V3::new(-FAST, -FAST, 0.0))
    };
    let split = allocator().split(Allocation::MotorAndBrake, &load);
    assert_eq!(split.usable, [true, true, false]);
    assert_eq!(split.brake_nm, V3::new(3.0, 10.0, 0.0));
    assert_eq!(split.motor_nm, V3::new(1.0, 13.5, 0.0));
}

#[test]
fn motor_cancels_a_brake_that_still_decays() {
    let load = Load {
        brake_nm: V3::new(4.0, 4.0, 0.0),
        ..moving(V3::new(1.0, -1.0, 0.0), V3::new(FAST, -FAST, 0.0))
    };
    let split = allocator().split(Allocation::MotorAndBrake, &load);
    assert_eq!(split.brake_nm, V3::zeros());
    assert_eq!(split.motor_nm, V3::new(5.0, -5.0, 0.0));
}

#[test]
fn compensation_of_a_decaying_brake_does_not_step_with_the_sense_of_motion() {
    let slow = brakes().omega_off_rad_per_s;
    let load = Load {
        brake_nm: V3::new(6.0, 0.0, 0.0),
        ..moving(V3::new(1.0, 0.0, 0.0), V3::new(slow, 0.0, 0.0))
    };
    let split = allocator().split(Allocation::MotorOnly, &load);
    assert!(
        (split.motor_nm[0] - 3.0).abs() < 1e-12,
        "{}",
        split.motor_nm
    );
}

#[test]
fn brake_alone_leaves_the_motors_off() {
    let load = moving(V3::new(3.0, -14.0, 0.0), V3::new(-FAST, FAST, 0.0));
    let split = allocator().split(Allocation::BrakeOnly, &load);
    assert_eq!(split.motor_nm, V3::zeros());
    assert_eq!(split.brake_nm, V3::new(3.0, 10.0, 0.0));
}

#[test]
fn sticking_joint_hands_its_load_over_within_some_tens_of_milliseconds() {
    let mut allocator = allocator();
    let mut load = resting(V3::new(4.0, 0.0, 0.0));
    let start = allocator.split(Allocation::MotorOnly, &load);
    assert_eq!(start.motor_nm[0], 4.0);
    load.brake_nm[0] = 9.0;
    let mut motor_nm = 4.0;
    for tick in 1..=60 {
        let split = allocator.split(Allocation::MotorAndBrake, &load);
        assert_eq!(split.brake_nm[0], 4.0);
        assert!(split.motor_nm[0] < motor_nm, "hand-over is not monotonic");
        motor_nm = split.motor_nm[0];
        if tick == 15 {
            assert!(
                (motor_nm - 4.0 * (-1.0_f64).exp()).abs() < 1e-9,
                "{motor_nm}"
            );
        }
    }
    assert!(motor_nm < 0.1);
}

#[test]
fn sticking_motor_keeps_what_the_brake_cannot_hold() {
    for sense in [1.0, -1.0] {
        let mut allocator = allocator();
        let mut load = resting(V3::new(sense * 15.0, 0.0, 0.0));
        load.brake_nm[0] = 9.0;
        for _ in 0..500 {
            let _ = allocator.split(Allocation::MotorAndBrake, &load);
        }
        let split = allocator.split(Allocation::MotorAndBrake, &load);
        assert!((split.motor_nm[0] - sense * 6.0).abs() < 1e-6);
        assert_eq!(split.brake_nm[0], 10.0);
    }
}

#[test]
fn motor_takes_the_load_back_at_once_when_the_brake_lets_go() {
    let mut allocator = allocator();
    let mut load = resting(V3::new(4.0, 0.0, 0.0));
    load.brake_nm[0] = 9.0;
    for _ in 0..200 {
        let _ = allocator.split(Allocation::MotorAndBrake, &load);
    }
    let unloaded = Load {
        hand_torque_nm: V3::zeros(),
        hand_force_n: V3::zeros(),
        ..load
    };
    let split = allocator.split(Allocation::MotorAndBrake, &unloaded);
    assert_eq!(split.motor_nm[0], 4.0);
    assert_eq!(split.brake_nm[0], 0.0);
}

#[test]
fn resting_hand_that_pulls_is_helped_against_a_brake_that_was_let_go() {
    let dead_zone_nm = brakes().hand_torque_min_nm;
    for (pulls_nm, helped) in [
        (0.0, 0.0),
        (dead_zone_nm, 0.0),
        (2.0 * dead_zone_nm, 0.5),
        (3.0 * dead_zone_nm, 1.0),
        (-5.0, -1.0),
    ] {
        let load = Load {
            hand_torque_nm: V3::new(pulls_nm, 0.0, 0.0),
            brake_nm: V3::new(6.0, 0.0, 0.0),
            ..Load::default()
        };
        let split = allocator().split(Allocation::MotorAndBrake, &load);
        assert!((split.motor_nm[0] - helped * SHARE * 6.0).abs() < 1e-12);
        let alone = allocator().split(Allocation::BrakeOnly, &load);
        assert_eq!(alone.motor_nm, V3::zeros());
    }
}

#[test]
fn hand_that_a_brake_holds_is_not_helped() {
    let load = Load {
        hold_nm: V3::new(10.0, 0.0, 0.0),
        hand_torque_nm: V3::new(-5.0, 0.0, 0.0),
        brake_nm: V3::new(6.0, 0.0, 0.0),
        ..Load::default()
    };
    let split = allocator().split(Allocation::MotorAndBrake, &load);
    assert!(split.usable[0]);
    assert_eq!(split.motor_nm, V3::zeros());
}

/// KS Fig. 5: the motor on axis 1 alone pushes, the brake on axis 2 alone resists.
#[test]
fn one_axis_by_motor_and_one_by_brake_as_in_the_paper() {
    let load = moving(V3::new(4.0, 4.0, 0.0), V3::new(0.03, -0.5, 0.0));
    let split = allocator().split(Allocation::MotorAndBrake, &load);
    assert_eq!(split.usable, [false, true, false]);
    assert_eq!(split.motor_nm[0], 4.0);
    assert_eq!(split.brake_nm, V3::new(0.0, 4.0, 0.0));
}

fn lone(force_n: V3, joint_force: V3) -> Load {
    let force_per_torque = M3::from_columns(&[joint_force, V3::new(0.0, 5.0, 0.0), V3::zeros()]);
    let torque_nm = V3::new(force_n.dot(&joint_force).signum(), 0.0, 0.0);
    Load {
        torque_nm,
        force_n,
        force_per_torque,
        ..Load::default()
    }
}

#[test]
fn lone_brake_gives_the_projection_of_the_force() {
    let load = lone(V3::new(10.0, 4.0, 0.0), V3::new(5.0, 0.0, 0.0));
    assert!((lone_brake_nm(&load, 0) - 2.0).abs() < 1e-12);
    let backwards = lone(V3::new(-10.0, 4.0, 0.0), V3::new(5.0, 0.0, 0.0));
    assert!((lone_brake_nm(&backwards, 0) - 2.0).abs() < 1e-12);
}

#[test]
fn lone_brake_that_points_elsewhere_gives_nothing() {
    let load = lone(V3::new(4.0, 4.1, 0.0), V3::new(5.0, 0.0, 0.0));
    assert_eq!(lone_brake_nm(&load, 0), 0.0);
    let just_inside = lone(V3::new(4.1, 4.0, 0.0), V3::new(5.0, 0.0, 0.0));
    assert!(lone_brake_nm(&just_inside, 0) > 0.0);
}

#[test]
fn lone_brake_that_would_act_against_the_joint_torque_wanted_gives_nothing() {
    let load = Load {
        torque_nm: V3::new(-1.0, 0.0, 0.0),
        ..lone(V3::new(10.0, 0.0, 0.0), V3::new(5.0, 0.0, 0.0))
    };
    assert_eq!(lone_brake_nm(&load, 0), 0.0);
    let at_zero = Load {
        torque_nm: V3::zeros(),
        ..load
    };
    assert_eq!(lone_brake_nm(&at_zero, 0), 0.0);
}

#[test]
fn lone_usable_brake_is_projected_in_brake_only_mode_and_no_other() {
    let load = Load {
        qd: V3::new(-FAST, 0.05, 0.0),
        force_n: V3::new(10.0, 4.0, 0.0),
        torque_nm: V3::new(3.0, 1.0, 0.0),
        force_per_torque: M3::from_columns(&[
            V3::new(5.0, 0.0, 0.0),
            V3::new(0.0, 5.0, 0.0),
            V3::zeros(),
        ]),
        ..Load::default()
    };
    let alone = allocator().split(Allocation::BrakeOnly, &load);
    assert_eq!(alone.usable, [true, false, false]);
    assert!((alone.brake_nm[0] - 2.0).abs() < 1e-12);
    let shared = allocator().split(Allocation::MotorAndBrake, &load);
    assert_eq!(shared.brake_nm[0], 3.0);
}

#[test]
fn brakes_without_torque_wanted_are_asked_for_nothing() {
    let load = moving(V3::zeros(), V3::new(-FAST, FAST, 0.0));
    for mode in [Allocation::BrakeOnly, Allocation::MotorAndBrake] {
        assert_eq!(allocator().split(mode, &load).brake_nm, V3::zeros());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// While moving with an exact brake model, motor and brake together give the torque wanted.
    #[test]
    fn shares_of_a_moving_joint_add_up(
        wanted in -20.0..20.0_f64,
        qd in prop_oneof![-3.0..-0.07_f64, 0.07..3.0_f64],
        built_up in 0.0..10.0_f64,
    ) {
        let load = Load {
            brake_nm: V3::new(built_up, 0.0, 0.0),
            ..moving(V3::new(wanted, 0.0, 0.0), V3::new(qd, 0.0, 0.0))
        };
        let split = allocator().split(Allocation::MotorAndBrake, &load);
        let given = split.motor_nm[0] - qd.signum() * built_up;
        prop_assert!((given - wanted).abs() < 1e-9);
    }

    /// Whatever is wanted, motors add to it no more than the brake has left, and at rest nothing
    /// against or without the hand.
    #[test]
    fn motors_help_the_hand_by_less_than_the_brake_has_left(
        wanted in -20.0..20.0_f64, own in -5.0..5.0_f64, qd in -0.1..0.1_f64,
        hand in -10.0..10.0_f64, built_up in 0.0..10.0_f64,
    ) {
        let load = Load {
            motor_only_nm: V3::new(own, 0.0, 0.0),
            hand_torque_nm: V3::new(hand, 0.0, 0.0),
            hand_force_n: V3::new(hand, 0.0, 0.0),
            brake_nm: V3::new(built_up, 0.0, 0.0),
            ..moving(V3::new(wanted, 0.0, 0.0), V3::new(qd, 0.0, 0.0))
        };
        let split = allocator().split(Allocation::MotorAndBrake, &load);
        let model = brakes();
        let help = split.motor_nm[0] - own - wanted;
        prop_assume!(!split.usable[0]);
        prop_assert!(help.abs() <= built_up * (1.0 + 1e-12));
        if qd.abs() < model.omega_off_rad_per_s {
            prop_assert!(help.abs() <= SHARE * built_up + 1e-9);
            prop_assert!(help * hand >= -1e-9);
            prop_assert!(hand.abs() > model.hand_torque_min_nm || help.abs() < 1e-9);
            prop_assert!((hand + own + wanted) * hand > 0.0 || help.abs() < 1e-9);
        } else {
            prop_assert!(help * hand >= -1e-9 || help * qd > 0.0, "against hand and motion");
        }
    }

    /// No motion near the thresholds makes the help of a pulling hand step by more than it grows.
    #[test]
    fn help_passes_smoothly_from_rest_to_motion(
        qd in 0.0..0.08_f64, pull in 0.5..10.0_f64, built_up in 0.0..10.0_f64,
    ) {
        let help = |qd: f64| {
            let load = Load {
                hand_torque_nm: V3::new(pull, 0.0, 0.0),
                brake_nm: V3::new(built_up, 0.0, 0.0),
                qd: V3::new(qd, 0.0, 0.0),
                ..Load::default()
            };
            allocator().split(Allocation::MotorAndBrake, &load).motor_nm[0]
        };
        let (here, ahead) = (help(qd), help(qd + 1e-4));
        prop_assert!(here >= SHARE * built_up - 1e-9);
        prop_assert!(ahead >= here - 1e-9 && ahead - here < 0.01 * built_up + 1e-9);
    }
}

#[test]
fn value_that_is_not_finite_reaches_the_bounds_instead_of_ending_the_loop() {
    for wanted_nm in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!hapticd_control::allocate::bridge_nm(wanted_nm, 0.0, 1.0).is_finite());
    }
    assert!(hapticd_control::allocate::bridge_nm(2.0, f64::NAN, 1.0).is_nan());
}
