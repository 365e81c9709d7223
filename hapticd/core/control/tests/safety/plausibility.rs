//! What an observation must be to be believed.

use crate::models::{hhd, phantom};
use hapticd_control::estimate::JointState;
use hapticd_control::fault::{Fault, FaultSet};
use hapticd_control::io::{status, Exchange, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::plausibility::{Plausibility, Reading, Verdict};

const PERIOD_S: f64 = 1e-3;
const PERIOD_NS: u64 = 1_000_000;
const NONE: FaultSet = FaultSet::from_bits(0);

/// A judge with its clock and the newest observation.
struct Bench {
    judge: Plausibility,
    observation: Observation,
    t_mono_ns: u64,
}

impl Bench {
    fn new(model: &DeviceModel) -> Self {
        Self {
            judge: Plausibility::new(model, PERIOD_S),
            observation: Observation {
                seq: 100,
                t_device_ns: 7 * PERIOD_NS,
                status: status::FORCE_PRESENT,
                ..Observation::default()
            },
            t_mono_ns: 1000 * PERIOD_NS,
        }
    }

    /// A bench whose judge has believed a first observation.
    fn started(model: &DeviceModel) -> Self {
        let mut bench = Self::new(model);
        let first = bench.judge(Exchange::Fresh);
        assert_eq!(first, verdict(Reading::First, NONE));
        bench
    }

    fn judge(&mut self, exchange: Exchange) -> Verdict {
        self.judge
            .judge(exchange, &self.observation, self.t_mono_ns)
    }

    fn pass(&mut self, ticks: u64) {
        self.t_mono_ns += ticks * PERIOD_NS;
    }

    /// The next frame, one period after the last, changed by `change`.
    fn next(&mut self, change: impl FnOnce(&mut Observation)) -> Verdict {
        self.pass(1);
        self.observation.seq += 1;
        self.observation.t_device_ns += PERIOD_NS;
        change(&mut self.observation);
        self.judge(Exchange::Fresh)
    }
}

fn verdict(reading: Reading, faults: FaultSet) -> Verdict {
    Verdict { reading, faults }
}

fn fresh(dt_s: f64) -> Verdict {
    verdict(Reading::Fresh { dt_s }, NONE)
}

fn disbelieved(fault: Fault) -> Verdict {
    verdict(Reading::Disbelieved, FaultSet::of(fault))
}

#[test]
fn steady_frames_are_believed_one_period_apart() {
    let mut bench = Bench::started(&hhd());
    for _ in 0..3 {
        assert_eq!(bench.next(|_| ()), fresh(1e-3));
    }
    assert_eq!((bench.judge.missing(), bench.judge.lost()), (0, 0));
}

#[test]
fn nothing_before_the_first_frame_is_nothing_and_no_fault() {
    let mut bench = Bench::new(&hhd());
    for _ in 0..20 {
        assert_eq!(
            bench.judge(Exchange::Missing),
            verdict(Reading::Nothing, NONE)
        );
    }
    assert_eq!(bench.judge(Exchange::Down), verdict(Reading::Nothing, NONE));
    assert_eq!(bench.judge.missing(), 0);
}

#[test]
fn missing_frames_coast_for_the_configured_ticks_and_no_longer() {
    let mut bench = Bench::started(&hhd());
    for missing in 1..=5 {
        bench.pass(1);
        assert_eq!(
            bench.judge(Exchange::Missing),
            verdict(Reading::Coast, NONE)
        );
        assert_eq!(bench.judge.missing(), missing);
    }
    let late = verdict(Reading::Coast, FaultSet::of(Fault::ObservationMissing));
    assert_eq!(bench.judge(Exchange::Missing), late);
}

#[test]
fn new_frame_ends_the_count_of_missing_ones() {
    let mut bench = Bench::started(&hhd());
    for _ in 0..4 {
        let _ = bench.judge(Exchange::Missing);
    }
    let _ = bench.next(|_| ());
    assert_eq!(bench.judge.missing(), 0);
    for _ in 0..5 {
        assert_eq!(bench.judge(Exchange::Missing).faults, NONE);
    }
}

#[test]
fn frame_seen_before_is_missing_however_fresh_the_driver_calls_it() {
    let mut bench = Bench::started(&hhd());
    assert_eq!(bench.judge(Exchange::Fresh), verdict(Reading::Coast, NONE));
    assert_eq!(bench.judge.missing(), 1);
}

#[test]
fn lost_frames_are_counted_by_the_gaps_and_widen_the_step() {
    let mut bench = Bench::started(&hhd());
    for _ in 0..3 {
        bench.pass(1);
        let _ = bench.judge(Exchange::Missing);
    }
    let late = bench.next(|frame| {
        frame.seq += 3;
        frame.t_device_ns += 3 * PERIOD_NS;
    });
    assert_eq!(late, fresh(4e-3));
    assert_eq!(bench.judge.lost(), 3);
    let _ = bench.next(|frame| frame.seq += 2);
    assert_eq!(bench.judge.lost(), 5);
}

#[test]
fn device_that_went_down_starts_anew() {
    let mut bench = Bench::started(&hhd());
    let _ = bench.judge(Exchange::Missing);
    assert_eq!(bench.judge(Exchange::Down), verdict(Reading::Nothing, NONE));
    assert_eq!(bench.judge.missing(), 0);
    let restarted = bench.next(|frame| {
        frame.seq = 1;
        frame.t_device_ns = 0;
        frame.counts[0] = 900_000;
    });
    assert_eq!(restarted, verdict(Reading::First, NONE));
    assert_eq!(bench.judge.lost(), 0);
}

#[test]
fn counter_or_clock_that_runs_backwards_is_broken() {
    let seq_back = Bench::started(&hhd()).next(|frame| frame.seq -= 2);
    assert_eq!(seq_back, disbelieved(Fault::SequenceBroken));
    let clock_back = Bench::started(&hhd()).next(|frame| frame.t_device_ns -= 2 * PERIOD_NS);
    assert_eq!(clock_back, disbelieved(Fault::SequenceBroken));
    let clock_stands = Bench::started(&hhd()).next(|frame| frame.t_device_ns -= PERIOD_NS);
    assert_eq!(clock_stands, fresh(0.5e-3));
}

#[test]
fn gap_in_the_device_clock_that_nobody_noticed_here_is_missing_frames() {
    let within = Bench::started(&hhd()).next(|frame| frame.t_device_ns += 5 * PERIOD_NS);
    assert_eq!(within, fresh(2e-3));
    let leap = Bench::started(&hhd()).next(|frame| frame.t_device_ns += 6 * PERIOD_NS);
    assert_eq!(leap, disbelieved(Fault::ObservationMissing));
}

#[test]
fn overrun_of_the_loop_is_not_blamed_on_the_device() {
    let mut bench = Bench::started(&hhd());
    bench.pass(20);
    let after = bench.next(|frame| frame.t_device_ns += 20 * PERIOD_NS);
    assert_eq!(after, fresh(21e-3));
}

#[test]
fn ticks_count_where_the_clock_here_stands() {
    let mut bench = Bench::started(&hhd());
    for _ in 0..3 {
        let _ = bench.judge(Exchange::Missing);
    }
    bench.observation.seq += 1;
    bench.observation.t_device_ns += 4 * PERIOD_NS;
    assert_eq!(bench.judge(Exchange::Fresh), fresh(4e-3));
}

#[test]
fn encoder_jumps_beyond_the_limit_are_disbelieved_on_every_joint_and_side() {
    let limit = (0.06 * 22281.7) as i64;
    for joint in 0..2 {
        for sense in [-1, 1] {
            let inside = Bench::started(&hhd()).next(|frame| frame.counts[joint] = sense * limit);
            assert_eq!(inside, fresh(1e-3));
            let beyond =
                Bench::started(&hhd()).next(|frame| frame.counts[joint] = sense * (limit + 1));
            assert_eq!(beyond, disbelieved(Fault::EncoderJump));
        }
    }
}

#[test]
fn jump_limit_grows_with_the_time_between_frames_but_never_shrinks() {
    let limit = (0.06 * 22281.7) as i64;
    let mut bench = Bench::started(&hhd());
    bench.pass(1);
    let _ = bench.judge(Exchange::Missing);
    let twice = |frame: &mut Observation| {
        frame.t_device_ns += PERIOD_NS;
        frame.counts[0] = 2 * limit;
    };
    assert_eq!(bench.next(twice), fresh(2e-3));
    let early = Bench::started(&hhd()).next(|frame| {
        frame.t_device_ns -= PERIOD_NS / 2;
        frame.counts[0] = limit;
    });
    assert_eq!(early, fresh(0.5e-3));
}

#[test]
fn counts_at_the_ends_of_their_range_jump_without_overflow() {
    let mut bench = Bench::started(&hhd());
    let verdict = bench.next(|frame| frame.counts = [i64::MAX, i64::MIN, 0]);
    assert_eq!(verdict, disbelieved(Fault::EncoderJump));
}

#[test]
fn frame_after_a_disbelieved_one_starts_anew() {
    let mut bench = Bench::started(&hhd());
    let _ = bench.next(|frame| frame.counts[0] = 50_000);
    assert_eq!(bench.next(|_| ()), verdict(Reading::First, NONE));
    assert_eq!(bench.next(|_| ()), fresh(1e-3));
}

#[test]
fn force_that_is_not_finite_is_disbelieved() {
    for bad in [f64::NAN, f64::INFINITY] {
        let force = Bench::started(&hhd()).next(|frame| frame.force_n[1] = bad);
        assert!(force.faults.contains(Fault::ObservationNotFinite));
        assert_eq!(force.reading, Reading::Disbelieved);
        let age = Bench::started(&hhd()).next(|frame| frame.force_age_s = bad);
        assert!(age.faults.contains(Fault::ObservationNotFinite));
    }
}

#[test]
fn values_that_are_not_there_are_not_judged() {
    let mut bench = Bench::started(&phantom());
    let without = bench.next(|frame| {
        frame.status = 0;
        frame.force_n = [f64::NAN; 3];
        frame.force_age_s = f64::NAN;
        frame.motor_current_a = [f64::NAN; 3];
    });
    assert_eq!(without, fresh(1e-3));
}

#[test]
fn current_that_is_not_finite_is_disbelieved() {
    let verdict = Bench::started(&hhd()).next(|frame| {
        frame.status |= status::CURRENT_PRESENT;
        frame.motor_current_a[2] = f64::NAN;
    });
    assert_eq!(verdict, disbelieved(Fault::ObservationNotFinite));
}

#[test]
fn saturated_sensor_is_a_soft_fault_and_the_encoders_are_still_believed() {
    let expected = verdict(
        Reading::Fresh { dt_s: 1e-3 },
        FaultSet::of(Fault::SensorSaturated),
    );
    let by_size = Bench::started(&hhd()).next(|frame| frame.force_n = [0.0, -300.0, 0.0]);
    assert_eq!(by_size, expected);
    let by_bit = Bench::started(&hhd()).next(|frame| frame.status |= status::SENSOR_SATURATED);
    assert_eq!(by_bit, expected);
    let inside = Bench::started(&hhd()).next(|frame| frame.force_n = [0.0, 299.9, 0.0]);
    assert_eq!(inside, fresh(1e-3));
}

#[test]
fn old_or_absent_force_of_a_device_with_a_sensor_is_stale() {
    let expected = verdict(
        Reading::Fresh { dt_s: 1e-3 },
        FaultSet::of(Fault::SensorStale),
    );
    for age_s in [0.0201, -0.001] {
        let old = Bench::started(&hhd()).next(|frame| frame.force_age_s = age_s);
        assert_eq!(old, expected);
    }
    let absent = Bench::started(&hhd()).next(|frame| frame.status = 0);
    assert_eq!(absent, expected);
    let young = Bench::started(&hhd()).next(|frame| frame.force_age_s = 0.02);
    assert_eq!(young, fresh(1e-3));
}

#[test]
fn sensor_that_the_model_does_not_have_is_not_judged() {
    let verdict = Bench::started(&phantom()).next(|frame| {
        frame.force_n = [1.0, 0.0, 0.0];
        frame.force_age_s = 1.0;
    });
    assert_eq!(verdict, fresh(1e-3));
}

#[test]
fn encoder_that_reports_an_error_is_disbelieved() {
    let verdict = Bench::started(&hhd()).next(|frame| frame.status |= status::ENCODER_ERROR);
    assert_eq!(verdict, disbelieved(Fault::Encoder));
}

fn motion(model: &DeviceModel, q: V3, xd: V3) -> FaultSet {
    let mut state = JointState::at(&model.kinematics, q, V3::zeros());
    state.xd = xd;
    Plausibility::new(model, PERIOD_S).judge_motion(&state)
}

#[test]
fn tip_faster_than_the_device_can_be_is_implausible() {
    let home = V3::from(hhd().joints.home_rad);
    assert_eq!(motion(&hhd(), home, V3::new(0.0, 6.0, 0.0)), NONE);
    for xd in [V3::new(-4.3, 4.3, 0.0), V3::new(f64::NAN, 0.0, 0.0)] {
        assert_eq!(
            motion(&hhd(), home, xd),
            FaultSet::of(Fault::SpeedImplausible)
        );
    }
}

#[test]
fn joint_past_its_limit_and_margin_is_outside() {
    let at = |q1: f64| motion(&hhd(), V3::new(q1, 2.6, 0.0), V3::zeros());
    assert_eq!(at(1.85), NONE);
    assert_eq!(at(-0.13), NONE);
    assert_eq!(at(-0.25), FaultSet::of(Fault::OutsideWorkspace));
}
