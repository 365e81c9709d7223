use crate::rig::{Rig, PERIOD_NS};
use hapticd_control::io::Exchange;
use hapticd_control::state::State;
use hapticd_servo::event::{TickPart, What};
use std::sync::atomic::Ordering;

#[test]
fn every_tick_is_published_once_and_on_its_deadline() {
    let report = Rig::new().run(|moment| {
        if moment.n == 50 {
            moment.stop.store(true, Ordering::Relaxed);
        }
    });
    let start_ns = report.field(0, "t_mono_ns");
    for tick in 0..report.ticks.len() {
        assert_eq!(report.field(tick, "tick"), tick as u64);
        let due_ns = start_ns + tick as u64 * PERIOD_NS;
        assert_eq!(report.field(tick, "t_mono_ns"), due_ns);
        assert_eq!(report.field(tick, "missed_ticks"), 0);
    }
}

#[test]
fn an_exchange_that_overruns_is_a_miss_with_its_cause_and_no_burst_follows() {
    let report = Rig::new().run(|moment| match moment.n {
        10 => moment.clock.spend(2 * PERIOD_NS + PERIOD_NS / 4),
        30 => moment.stop.store(true, Ordering::Relaxed),
        _ => {}
    });
    let misses: Vec<_> = report
        .events
        .iter()
        .filter_map(|event| match event.what {
            What::Miss(miss) => Some((event.tick, miss)),
            _ => None,
        })
        .collect();
    assert_eq!(misses.len(), 1);
    let (tick, miss) = misses[0];
    assert_eq!((tick, miss.skipped, miss.part), (10, 2, TickPart::Exchange));
    assert_eq!(miss.exchange_ns, 2 * PERIOD_NS + PERIOD_NS / 4);
    assert_eq!(report.field(11, "missed_ticks"), 2);
    assert_eq!(report.field(11, "exchange_ns"), miss.exchange_ns);
    for tick in 1..report.ticks.len() {
        let gap_ns = report.field(tick, "t_mono_ns") - report.field(tick - 1, "t_mono_ns");
        assert!(gap_ns >= PERIOD_NS, "tick {tick} came after {gap_ns} ns");
    }
}

#[test]
fn a_lost_device_is_offline_and_comes_back_disabled() {
    let report = Rig::new().run(|moment| match moment.n {
        20 => {
            moment.send(r#"{"type":"desired","desired":"enabled"}"#);
        }
        60..=80 => moment.reply = Exchange::Down,
        120 => moment.stop.store(true, Ordering::Relaxed),
        _ => {}
    });
    assert_eq!(report.field(59, "state"), State::Enabled as u64);
    assert_eq!(report.field(61, "state"), State::Offline as u64);
    assert_eq!(report.field(119, "state"), State::Disabled as u64);
    assert_ne!(report.field(119, "faults"), 0, "the loss stays latched");
    assert!(report.tells(What::Device { present: false }));
    let returns = report
        .events
        .iter()
        .filter(|event| event.what == What::Device { present: true });
    assert_eq!(returns.count(), 2);
}

#[test]
fn the_twin_tells_where_its_hand_is() {
    let report = Rig::new().run(|moment| match moment.n {
        5 => {
            moment.send(
                r#"{"type":"hand","script":{"type":"push","direction":[0,0,-1],"force_n":2}}"#,
            );
        }
        200 => moment.stop.store(true, Ordering::Relaxed),
        _ => {}
    });
    let hand_m = report.axes(150, "hand_position_m");
    let tip_m = report.axes(150, "tip_position_m");
    for (hand_m, tip_m) in hand_m.into_iter().zip(tip_m) {
        assert!((hand_m - tip_m).abs() < 0.02, "hand {hand_m}, tip {tip_m}");
    }
    assert_ne!(report.axes(150, "hand_force_n"), [0.0; 3]);
}
