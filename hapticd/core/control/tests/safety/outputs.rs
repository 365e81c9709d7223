//! The watch over outputs that were asked for.

use hapticd_control::fault::{Fault, FaultSet};
use hapticd_control::io::status::{AMPLIFIER_FAULT, BOARD_WATCHDOG, OUTPUTS_LIVE};
use hapticd_control::outputs::OutputWatch;

const DT_S: f64 = 1e-3;
const NONE: FaultSet = FaultSet::from_bits(0);

/// A watch over outputs that have been live for `ticks`.
fn live_for(ticks: usize) -> OutputWatch {
    let mut watch = OutputWatch::default();
    for _ in 0..ticks {
        assert_eq!(watch.judge(OUTPUTS_LIVE, true, DT_S), NONE);
        assert!(watch.live());
    }
    watch
}

fn live() -> OutputWatch {
    live_for(300)
}

#[test]
fn what_a_board_latched_while_off_is_no_fault() {
    let mut watch = OutputWatch::default();
    for _ in 0..1000 {
        assert_eq!(
            watch.judge(BOARD_WATCHDOG | AMPLIFIER_FAULT, false, DT_S),
            NONE
        );
    }
    assert!(!watch.live());
}

#[test]
fn board_may_take_a_quarter_of_a_second_to_go_live() {
    let mut watch = OutputWatch::default();
    for _ in 0..249 {
        assert_eq!(watch.judge(0, true, DT_S), NONE);
    }
    for _ in 0..3 {
        let _ = watch.judge(0, true, DT_S);
    }
    assert_eq!(
        watch.judge(0, true, DT_S),
        FaultSet::of(Fault::OutputsNotLive)
    );
}

#[test]
fn waiting_starts_anew_with_every_asking() {
    let mut watch = OutputWatch::default();
    for _ in 0..4 {
        for _ in 0..200 {
            assert_eq!(watch.judge(0, true, DT_S), NONE);
        }
        assert_eq!(watch.judge(0, false, DT_S), NONE);
    }
}

#[test]
fn outputs_that_die_are_a_fault_at_once() {
    assert_eq!(
        live().judge(0, true, DT_S),
        FaultSet::of(Fault::OutputsNotLive)
    );
}

#[test]
fn frame_from_before_the_asking_does_not_make_the_start_up_a_fault() {
    let mut watch = live_for(2);
    for _ in 0..200 {
        assert_eq!(watch.judge(0, true, DT_S), NONE);
        assert!(!watch.live());
    }
    assert_eq!(watch.judge(OUTPUTS_LIVE, true, DT_S), NONE);
}

#[test]
fn outputs_that_were_withdrawn_may_go_off() {
    let mut watch = live();
    assert_eq!(watch.judge(0, false, DT_S), NONE);
    assert!(!watch.live());
}

#[test]
fn bits_that_tell_more_are_blamed_instead() {
    for (bit, fault) in [
        (AMPLIFIER_FAULT, Fault::Amplifier),
        (BOARD_WATCHDOG, Fault::BoardWatchdog),
    ] {
        assert_eq!(live().judge(bit, true, DT_S), FaultSet::of(fault));
        let young = live_for(1).judge(bit | OUTPUTS_LIVE, true, DT_S);
        assert_eq!(young, FaultSet::of(fault));
        assert_eq!(
            live().judge(bit | OUTPUTS_LIVE, true, DT_S),
            FaultSet::of(fault)
        );
    }
}

#[test]
fn live_outputs_that_nobody_asked_for_do_not_count_as_live() {
    let mut watch = OutputWatch::default();
    let _ = watch.judge(OUTPUTS_LIVE, false, DT_S);
    assert!(!watch.live());
}
