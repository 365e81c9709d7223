//! The whole tick where something stays away: frames, the device, the front, time.

use crate::models::{hhd, phantom};
use crate::rig::{ask, fade_out, is_zero, tip_force_n, Rig};
use hapticd_control::controller::{Event, State};
use hapticd_control::fault::Fault;
use hapticd_control::interlock;
use hapticd_control::io::{status, Exchange};
use hapticd_control::linear::V3;
use hapticd_control::record::flag;

#[test]
fn missing_frame_repeats_the_last_command() {
    for model in [phantom(), hhd()] {
        let mut rig = Rig::pressing(model, 0.002);
        let before = rig.command;
        for missing in 1..=5 {
            let command = rig.exchange(Exchange::Missing);
            for i in 0..3 {
                // The torque stays; the volts follow the winding as it warms.
                let drift_v = command.motor_v[i] - before.motor_v[i];
                assert!(drift_v.abs() <= 0.01 * before.motor_v[i].abs());
                assert!((command.motor_torque_nm[i] - before.motor_torque_nm[i]).abs() < 1e-9);
            }
            assert_eq!(rig.record.observation_missing, missing);
            assert_eq!(rig.record.flags & flag::FRESH, 0);
        }
        assert!(is_zero(&rig.exchange(Exchange::Missing)));
        assert!(rig.has(Fault::ObservationMissing));
    }
}

#[test]
fn coasting_does_not_follow_a_new_scene() {
    let mut rig = Rig::running(hhd());
    rig.wall_at(0.002, 0.0);
    rig.exchange(Exchange::Missing);
    assert!(tip_force_n(&rig.record).norm() < 1e-9);
    rig.steps(3);
    assert!(tip_force_n(&rig.record).norm() > 1.0);
}

#[test]
fn fade_goes_on_while_frames_are_missing() {
    let mut rig = Rig::pressing(hhd(), 0.002);
    let start_n = tip_force_n(&rig.record).norm();
    ask(&mut rig, Event::Disable);
    for _ in 0..12 {
        for _ in 0..4 {
            rig.exchange(Exchange::Missing);
        }
        rig.step();
    }
    let left = tip_force_n(&rig.record).norm() / start_n;
    assert!((left - 0.4).abs() < 0.03, "{left}");
}

#[test]
fn coasting_does_not_rise_with_the_ramp() {
    let mut rig = Rig::new(hhd());
    rig.enable();
    rig.wall_at(0.002, 0.0);
    rig.steps(100);
    let before_n = tip_force_n(&rig.record).norm();
    rig.exchange(Exchange::Missing);
    assert!((tip_force_n(&rig.record).norm() - before_n).abs() < 1e-9);
}

#[test]
fn impossible_observation_is_zero_in_its_own_tick() {
    let mut rig = Rig::pressing(hhd(), 0.002);
    let pose = rig.record.joint_position_rad;
    rig.observation.counts[0] += 5000;
    assert!(is_zero(&rig.step()));
    assert!(rig.has(Fault::EncoderJump));
    assert_eq!(rig.record.joint_position_rad, pose, "it became a value");
}

#[test]
fn motion_faster_than_the_device_can_be_is_zero_in_its_own_tick() {
    let mut rig = Rig::pressing(hhd(), 0.002);
    let mut q = V3::from(rig.record.joint_position_rad);
    for _ in 0..4 {
        q[0] += 0.055;
        rig.place(&q);
        rig.step();
    }
    assert!(rig.has(Fault::SpeedImplausible));
    assert!(is_zero(&rig.command));
}

#[test]
fn lost_device_is_offline_and_comes_back_disabled_with_its_fault() {
    let mut rig = Rig::pressing(phantom(), 0.002);
    assert!(is_zero(&rig.exchange(Exchange::Down)));
    assert_eq!(rig.state(), State::Offline);
    assert!(rig.has(Fault::DeviceLost));
    rig.observation.seq = 0;
    rig.observation.t_device_ns = 0;
    assert!(is_zero(&rig.step()));
    assert_eq!(rig.state(), State::Disabled);
    assert!(rig.has(Fault::DeviceLost));
    rig.acknowledge_all();
    ask(&mut rig, Event::Enable);
    rig.steps(2);
    assert!(
        tip_force_n(&rig.record).norm() < 0.1,
        "reconnecting stepped the force"
    );
}

#[test]
fn dead_front_fades_and_stays_off() {
    let mut rig = Rig::pressing(phantom(), 0.002);
    rig.front_alive = false;
    rig.step();
    assert!(rig.has(Fault::FrontLost));
    assert!(rig.command.enable, "cut instead of faded");
    let _ = fade_out(&mut rig);
    rig.front_alive = true;
    rig.steps(10);
    assert!(is_zero(&rig.command));
    assert_eq!(rig.state(), State::Fault);
}

#[test]
fn dead_front_of_an_idle_device_is_an_interlock_and_no_fault() {
    let mut rig = Rig::new(phantom());
    rig.front_alive = false;
    rig.steps(5);
    assert_eq!(rig.record.faults, 0);
    assert_eq!(rig.controller.interlocks(), interlock::FRONT_MISSING);
}

#[test]
fn realtime_that_was_not_obtained_is_an_interlock() {
    let mut rig = Rig::new(phantom());
    rig.realtime_ok = false;
    rig.step();
    assert_eq!(rig.controller.interlocks(), interlock::REALTIME_MISSING);
}

#[test]
fn busy_device_cannot_be_enabled() {
    let mut rig = Rig::new(phantom());
    rig.controller.set_busy(true);
    rig.step();
    assert_eq!(rig.controller.interlocks(), interlock::BUSY);
    assert_ne!(rig.record.flags & flag::BUSY, 0);
    rig.controller.set_busy(false);
    assert_eq!(rig.controller.interlocks(), 0);
}

#[test]
fn late_ticks_in_a_row_are_a_fault_and_single_ones_are_not() {
    let mut rig = Rig::pressing(phantom(), 0.002);
    for _ in 0..3 {
        rig.late = true;
        rig.steps(19);
        assert_eq!(rig.record.faults, 0);
        rig.late = false;
        rig.step();
    }
    rig.late = true;
    rig.steps(20);
    assert!(rig.has(Fault::DeadlineMissed));
}

#[test]
fn late_ticks_of_an_idle_device_are_no_fault() {
    let mut rig = Rig::new(phantom());
    rig.late = true;
    rig.steps(50);
    assert_eq!(rig.record.faults, 0);
}

#[test]
fn joint_zero_lost_in_use_is_zero_in_its_own_tick() {
    let mut rig = Rig::pressing(phantom(), 0.002);
    rig.observation.status &= !status::HOMED;
    assert!(is_zero(&rig.step()));
    assert!(rig.has(Fault::Encoder));
    assert_eq!(rig.record.flags & flag::HOMED, 0);
}
