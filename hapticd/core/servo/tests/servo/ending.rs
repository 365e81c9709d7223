use crate::rig::{Rig, SILENCE_NS};
use hapticd_control::io::Command;
use hapticd_servo::event::{StopReason, What};
use hapticd_servo::front::Front;
use hapticd_servo::status::Phase;
use std::sync::atomic::Ordering;

const ENABLE: &str = r#"{"type":"desired","desired":"enabled"}"#;

#[test]
fn a_stopped_loop_hands_zeros_to_the_device_last() {
    let mut last = None;
    let report = Rig::new().run(|moment| {
        last = Some(moment.command);
        match moment.n {
            20 => {
                moment.send(ENABLE);
            }
            400 => {
                assert!(moment.command.enable, "the device was live");
                moment.stop.store(true, Ordering::Relaxed);
            }
            _ => {}
        }
    });
    assert_eq!(last, Some(Command::default()));
    assert_eq!(report.reason, StopReason::Requested);
    assert!(report.tells(What::Stopped(StopReason::Requested)));
}

#[test]
fn a_live_loop_fades_before_it_stops() {
    let report = Rig::new().run(|moment| match moment.n {
        20 => {
            moment.send(ENABLE);
        }
        400 => {
            moment.send(r#"{"type":"stop"}"#);
        }
        _ => {}
    });
    let gain = |tick| f64::from_bits(report.field(tick, "gain"));
    let end = report.ticks.len();
    assert_eq!(gain(400), 1.0);
    assert!(end > 402, "the fade took {} ticks", end - 400);
    assert!((401..end).all(|tick| gain(tick) <= gain(tick - 1)));
    assert_eq!(gain(end - 1), 0.0);
    assert_eq!(report.acks.len(), 2);
}

#[test]
fn a_loop_without_a_front_ends_by_itself() {
    let mut rig = Rig::new();
    rig.orphan_ns = Some(SILENCE_NS / 2);
    let report = rig.run(|moment| {
        moment.beat = moment.n < 10;
        if moment.n == 40 {
            moment.clock.spend(SILENCE_NS);
        }
    });
    assert_eq!(report.reason, StopReason::Orphaned);
}

#[test]
fn a_loop_that_never_had_a_front_ends_by_itself_too() {
    let mut rig = Rig::new();
    rig.orphan_ns = Some(SILENCE_NS / 2);
    let report = rig.run(|moment| {
        moment.beat = false;
        if moment.n == 40 {
            moment.clock.spend(SILENCE_NS);
        }
    });
    assert_eq!(report.reason, StopReason::Orphaned);
}

#[test]
fn a_stopped_servo_is_not_alive_for_its_front() {
    let rig = Rig::new();
    let path = rig.path();
    rig.run(|moment| {
        if moment.n == 5 {
            moment.stop.store(true, Ordering::Relaxed);
        }
    });
    let front = Front::attach(path, true).unwrap();
    assert_eq!(front.phase(), Phase::Stopped);
    assert!(!front.servo_alive());
}
