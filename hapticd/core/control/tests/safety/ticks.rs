//! The whole tick in the situations that the laws are about.

use crate::models::{any_model, hhd, phantom};
use crate::rig::{ask, fade_out, is_zero, scene, tip_force_n, Rig, RATE_HZ};
use hapticd_control::controller::{Event, State};
use hapticd_control::fault::Fault;
use hapticd_control::interlock;
use hapticd_control::io::{status, Exchange};
use hapticd_control::linear::V3;
use hapticd_control::record::{flag, limit, NO_WALL};
use hapticd_control::scene::{Scene, Wall};
use proptest::prelude::*;

#[test]
fn device_is_offline_until_heard_and_then_disabled() {
    let mut rig = Rig::new(phantom());
    rig.exchange(Exchange::Missing);
    assert_eq!(rig.state(), State::Offline);
    assert_ne!(rig.controller.interlocks() & interlock::OFFLINE, 0);
    rig.exchange(Exchange::Down);
    assert_eq!(rig.record.faults, 0, "never connected is no loss");
    rig.step();
    assert_eq!(rig.state(), State::Disabled);
    assert_eq!(rig.controller.interlocks(), 0);
    assert!(is_zero(&rig.command));
}

#[test]
fn enabling_ramps_up_in_contact_without_a_step() {
    for model in [phantom(), hhd()] {
        let mut rig = Rig::new(model);
        rig.enable();
        rig.wall_at(0.002, 0.0);
        let mut gains = vec![];
        for _ in 0..(rig.model.limits.ramp_s * RATE_HZ) as usize + 10 {
            let before = tip_force_n(&rig.record);
            rig.step();
            gains.push(rig.record.gain);
            let step_n = (tip_force_n(&rig.record) - before).norm();
            assert!(step_n < 0.01 * rig.model.limits.tip_force_n, "{step_n}");
        }
        assert!(gains.windows(2).all(|pair| pair[1] >= pair[0]));
        assert_eq!(gains.last(), Some(&1.0));
        assert!(tip_force_n(&rig.record).norm() > 1.0);
    }
}

#[test]
fn ramp_waits_for_a_board_that_takes_its_time() {
    let mut rig = Rig::new(phantom());
    rig.enable();
    rig.wall_at(0.002, 0.0);
    rig.obeys = false;
    rig.steps(200);
    assert!(rig.command.enable);
    assert_eq!(rig.record.gain, 0.0);
    rig.obeys = true;
    rig.steps(3);
    assert!(rig.record.gain > 0.0 && rig.record.gain < 0.02);
    assert!(tip_force_n(&rig.record).norm() < 0.1);
}

#[test]
fn motors_of_a_board_that_is_not_live_count_as_off() {
    let mut rig = Rig::new(hhd());
    rig.enable();
    rig.wall_at(0.002, 0.0);
    rig.steps(50);
    assert!(V3::from(rig.record.motor_torque_estimate_nm).norm() > 0.1);
    rig.obeys = false;
    rig.step();
    assert_eq!(rig.record.motor_torque_estimate_nm, [0.0; 3]);
}

#[test]
fn motors_that_were_cut_count_as_off_while_frames_are_missing() {
    let mut rig = Rig::running(phantom());
    let mut q = rig.home();
    for _ in 0..10 {
        q[0] += 0.002;
        rig.place(&q);
        rig.step();
    }
    ask(&mut rig, Event::EstopEngage);
    rig.exchange(Exchange::Missing);
    rig.exchange(Exchange::Missing);
    assert_eq!(rig.record.motor_torque_estimate_nm, [0.0; 3]);
}

#[test]
fn board_that_never_goes_live_is_a_fault() {
    let mut rig = Rig::new(phantom());
    rig.obeys = false;
    rig.enable();
    rig.steps(300);
    assert!(rig.has(Fault::OutputsNotLive));
    assert_eq!(rig.state(), State::Fault);
}

#[test]
fn disabling_and_pausing_fade_within_bounded_time_and_without_a_step() {
    for event in [Event::Disable, Event::Pause] {
        for model in [phantom(), hhd()] {
            let mut rig = Rig::pressing(model, 0.002);
            let start_n = tip_force_n(&rig.record).norm();
            ask(&mut rig, event);
            rig.step();
            assert!(rig.command.enable, "cut instead of faded");
            assert!(rig.record.flags & flag::FADING != 0);
            let largest_n = fade_out(&mut rig);
            assert!(largest_n < 0.05 * start_n, "{largest_n} of {start_n}");
            assert!(is_zero(&rig.command));
            assert_eq!(rig.record.flags & flag::FADING, 0);
        }
    }
}

#[test]
fn resuming_from_pause_ramps_again() {
    let mut rig = Rig::pressing(phantom(), 0.002);
    let full_n = tip_force_n(&rig.record).norm();
    ask(&mut rig, Event::Pause);
    let _ = fade_out(&mut rig);
    assert_eq!(rig.state(), State::Paused);
    ask(&mut rig, Event::Enable);
    rig.steps(3);
    assert!(tip_force_n(&rig.record).norm() < 0.02 * full_n);
    rig.steps(400);
    assert!((tip_force_n(&rig.record).norm() - full_n).abs() < 1e-3 * full_n);
}

#[test]
fn estop_is_zero_in_the_next_tick_and_latches() {
    let mut rig = Rig::pressing(hhd(), 0.002);
    ask(&mut rig, Event::EstopEngage);
    assert!(is_zero(&rig.step()));
    assert_ne!(rig.record.flags & flag::ESTOP, 0);
    assert_eq!(rig.state(), State::Disabled);
    let refusal = rig.controller.event(Event::Enable).expect_err("latched");
    assert_eq!(refusal.interlocks, interlock::ESTOP_LATCHED);
    ask(&mut rig, Event::EstopAcknowledge);
    ask(&mut rig, Event::Enable);
}

#[test]
fn estop_input_acts_in_its_own_tick_and_is_not_acknowledged_while_open() {
    let mut rig = Rig::pressing(hhd(), 0.002);
    rig.observation.status |= status::ESTOP_INPUT;
    assert!(is_zero(&rig.step()));
    assert!(rig.controller.event(Event::EstopAcknowledge).is_err());
    rig.observation.status &= !status::ESTOP_INPUT;
    rig.step();
    assert_ne!(
        rig.record.flags & flag::ESTOP,
        0,
        "the latch fell with its input"
    );
    ask(&mut rig, Event::EstopAcknowledge);
}

#[test]
fn estop_input_is_forgotten_with_the_device() {
    let mut rig = Rig::running(hhd());
    rig.observation.status |= status::ESTOP_INPUT;
    rig.step();
    rig.exchange(Exchange::Down);
    assert_eq!(rig.controller.interlocks() & interlock::ESTOP_INPUT, 0);
    assert_ne!(rig.controller.interlocks() & interlock::ESTOP_LATCHED, 0);
}

#[test]
fn wall_put_around_the_tool_without_a_fade_is_slewed_in() {
    for mut model in [phantom(), hhd()] {
        model.limits.tip_slew_n_per_s *= 0.2;
        let mut rig = Rig::running(model);
        rig.wall_at(0.02, 0.0);
        let slew_n = rig.model.limits.tip_slew_n_per_s / RATE_HZ;
        let mut slewed = false;
        for _ in 0..60 {
            let before = rig.record.motor_torque_estimate_nm;
            rig.step();
            slewed |= rig.record.limits & limit::SLEW != 0;
            let change_nm = V3::from(rig.record.motor_torque_estimate_nm) - V3::from(before);
            let inverse = rig
                .model
                .kinematics
                .jacobian_inverse(&V3::from(rig.record.joint_position_rad));
            let change_n = inverse.unwrap_or_default().tr_mul(&change_nm).norm();
            assert!(change_n <= slew_n * 1.001, "{change_n}");
        }
        assert!(slewed);
        let settled_n = tip_force_n(&rig.record).norm();
        assert!(
            (settled_n - rig.model.limits.tip_force_n).abs() < 1e-6,
            "{settled_n}"
        );
        assert_ne!(rig.record.limits & limit::TIP_FORCE, 0);
    }
}

#[test]
fn value_that_is_not_finite_stops_in_its_own_tick() {
    let mut rig = Rig::pressing(hhd(), 0.001);
    let absurd = Wall::plane(1, [0.0, -1.0, 0.0], 1e308, 0.0);
    rig.controller.adopt(&scene(&[absurd], 0.0));
    assert!(is_zero(&rig.step()));
    assert!(rig.has(Fault::OutputNotFinite));
    assert_ne!(rig.record.limits & limit::NON_FINITE, 0);
    assert_eq!(rig.record.gain, 0.0);
}

#[test]
fn outputs_fade_towards_a_singularity() {
    let mut model = phantom();
    model.limits.singularity_margin = 0.9;
    let mut rig = Rig::pressing(model, 0.002);
    let away_n = tip_force_n(&rig.record).norm();
    let mut q = rig.home();
    for _ in 0..300 {
        if rig.record.singularity_margin > 0.65 {
            q[2] += 0.003;
            rig.place(&q);
            rig.step();
        }
    }
    rig.wall_at(0.002, 0.0);
    rig.steps(20);
    assert_ne!(rig.record.limits & limit::SINGULARITY, 0);
    let near_n = tip_force_n(&rig.record).norm();
    assert!(near_n > 0.0 && near_n < 0.6 * away_n, "{near_n} {away_n}");
    assert_eq!(rig.record.faults, 0);
}

#[test]
fn record_says_what_happened() {
    let mut rig = Rig::pressing(phantom(), 0.001);
    let quiet = flag::HOMED | flag::FRESH | flag::CONTACT;
    let record = rig.record;
    assert_eq!(record.flags, quiet);
    assert_eq!(
        (record.tick, record.t_mono_ns),
        (rig.tick, rig.tick * 1_000_000)
    );
    assert_eq!(record.observation_seq, rig.observation.seq);
    assert_eq!(record.t_device_ns, rig.observation.t_device_ns);
    assert_eq!(record.observation_status, rig.observation.status);
    assert_eq!(
        (record.scene_revision, record.state),
        (1, State::Enabled as u64)
    );
    assert_eq!((record.contact_count, record.contact_wall), (1, 0));
    assert!((record.contact_depth_m - 0.001).abs() < 1e-9);
    assert_eq!(record.motor_v, rig.command.motor_v);
    let depth = V3::from(record.setpoint_position_m) - V3::from(record.tip_position_m);
    assert!((depth.norm() - 0.001).abs() < 1e-8);
    let model_n = V3::from(record.tip_force_n) - tip_force_n(&record);
    assert!(model_n.norm() < 1e-2);
    rig.observation.seq += 4;
    rig.step();
    assert_eq!(rig.record.observation_lost, 4);
    rig.controller.adopt(&Scene {
        revision: 9,
        ..scene(&[], 0.05)
    });
    rig.step();
    assert_eq!(rig.record.scene_revision, 9);
    assert_eq!(rig.record.contact_wall, NO_WALL);
    assert_eq!(rig.record.flags, flag::HOMED | flag::FRESH | flag::FADING);
    rig.steps(60);
    assert_eq!(rig.record.flags, flag::HOMED | flag::FRESH);
}

#[test]
fn measured_force_and_current_are_recorded_only_where_they_are_measured() {
    let mut rig = Rig::running(hhd());
    rig.hand(V3::new(1.0, -2.0, 0.0));
    rig.step();
    assert_eq!(rig.record.sensor_force_n, [1.0, -2.0, 0.0]);
    let mut rig = Rig::running(phantom());
    rig.hand(V3::new(1.0, -2.0, 3.0));
    rig.observation.motor_current_a = [0.5, 0.0, 0.0];
    rig.step();
    assert_eq!(rig.record.sensor_force_n, [0.0; 3]);
    assert!(rig.record.motor_current_a[0].abs() < 0.1);
    rig.observation.status |= status::CURRENT_PRESENT;
    rig.step();
    assert_eq!(rig.record.motor_current_a, [0.5, 0.0, 0.0]);
}

#[test]
fn workspace_stiffness_is_the_same_everywhere_and_never_above_the_pose() {
    let mut seen = vec![];
    for q2 in [0.5, 0.9, 1.2] {
        let mut rig = Rig::running(phantom());
        let pose_n_per_m = {
            rig.place(&V3::new(0.0, q2, q2 + 0.2));
            rig.acknowledge_all();
            rig.exchange(Exchange::Down);
            rig.step();
            rig.record.stiffness_n_per_m
        };
        rig.controller.adopt(&Scene {
            stiffness: hapticd_control::scene::StiffnessScope::Workspace,
            ..scene(&[], 0.0)
        });
        rig.step();
        assert!(rig.record.stiffness_n_per_m <= pose_n_per_m);
        seen.push(rig.record.stiffness_n_per_m);
    }
    assert!(seen
        .iter()
        .all(|stiffness| (stiffness - seen[0]).abs() < 1e-6 * seen[0]));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    /// Law 2: from full contact to nothing within two fade times, whatever the device.
    #[test]
    fn every_soft_stop_ends_in_nothing_within_two_fades(model in any_model(), depth_m in 0.0..0.01_f64) {
        let releases = model.brakes.is_none_or(|brakes| brakes.release_on_stop);
        let mut rig = Rig::pressing(model, depth_m);
        ask(&mut rig, Event::Disable);
        let _ = fade_out(&mut rig);
        prop_assert!(is_zero(&rig.command) || !releases);
    }
}
