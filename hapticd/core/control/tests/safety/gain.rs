//! Ramp and fade.

use crate::models::phantom;
use hapticd_control::gain::Gain;
use hapticd_control::model::LimitModel;
use hapticd_control::state::Output;

const DT_S: f64 = 1e-3;

fn limits() -> LimitModel {
    LimitModel {
        ramp_s: 0.02,
        fade_s: 0.01,
        ..phantom().limits
    }
}

fn after(gain: Gain, output: Output, live: bool, ticks: usize) -> Gain {
    let mut gain = gain;
    for _ in 0..ticks {
        gain.advance(output, live, &limits(), DT_S);
    }
    gain
}

fn full() -> Gain {
    after(Gain::default(), Output::Drive, true, 30)
}

#[test]
fn ramp_takes_its_time_and_ends_at_one() {
    let half = after(Gain::default(), Output::Drive, true, 10);
    assert!((half.value - 0.5).abs() < 1e-12);
    assert_eq!(full().value, 1.0);
}

#[test]
fn ramp_waits_for_live_outputs() {
    assert_eq!(after(Gain::default(), Output::Drive, false, 10).value, 0.0);
}

#[test]
fn fade_takes_its_time_and_ends_at_zero() {
    let most = after(full(), Output::Fade, true, 4);
    assert!((most.value - 0.6).abs() < 1e-12);
    assert_eq!(after(full(), Output::Fade, true, 15).value, 0.0);
}

#[test]
fn cut_is_zero_at_once() {
    assert_eq!(after(full(), Output::Cut, true, 1).value, 0.0);
}

#[test]
fn idle_time_counts_from_the_end_of_the_fade() {
    let faded = after(full(), Output::Fade, true, 16);
    assert!((faded.idle_s - 6.0 * DT_S).abs() < 2.0 * DT_S);
    let later = after(faded, Output::Fade, true, 5);
    assert!((later.idle_s - faded.idle_s - 5.0 * DT_S).abs() < 1e-12);
    assert_eq!(after(faded, Output::Drive, true, 1).idle_s, 0.0);
}
