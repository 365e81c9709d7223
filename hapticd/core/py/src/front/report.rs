//! The core's reports as dictionaries; `hapticd/_core.pyi` types them.

use hapticd_servo::ack::{Ack, Outcome};
use hapticd_servo::event::{Miss, ServoEvent, StopReason, TickPart, What};
use hapticd_servo::front::Front;
use hapticd_servo::histogram::{edge_ns, Histogram, BUCKETS};
use hapticd_servo::layout::{schema_hash, VERSION};
use hapticd_servo::region::Region;
use hapticd_servo::scheduling::{shortfalls, Policy, Realtime};
use hapticd_servo::status::{Phase, Status};
use pyo3::prelude::*;
use std::collections::BTreeMap;

/// Names of the device's states, by their numbers.
const STATES: [&str; 5] = ["offline", "disabled", "enabled", "paused", "fault"];

fn state_name(number: u64) -> &'static str {
    let index = usize::try_from(number).unwrap_or(usize::MAX);
    STATES.get(index).copied().unwrap_or("unknown")
}

#[derive(IntoPyObject)]
pub struct InfoDict {
    device_id: String,
    rate_hz: f64,
    pid: u32,
    started_utc_ns: u64,
    started_mono_ns: u64,
    boot_id: String,
    is_twin: bool,
    layout_version: u64,
    schema_hash: u64,
    tick_capacity: usize,
}

impl InfoDict {
    pub fn of(region: &Region) -> Self {
        let info = region.info();
        Self {
            device_id: info.device_id,
            rate_hz: info.rate_hz,
            pid: info.pid,
            started_utc_ns: info.started_utc_ns,
            started_mono_ns: info.started_mono_ns,
            boot_id: format!("{:032x}", info.boot_id),
            is_twin: info.twin,
            layout_version: VERSION,
            schema_hash: schema_hash(),
            tick_capacity: region.layout().tick_capacity,
        }
    }
}

#[derive(IntoPyObject)]
pub struct AckDict {
    id: u64,
    tick: u64,
    t_mono_ns: u64,
    result: &'static str,
    interlocks: u64,
    state: &'static str,
}

impl AckDict {
    pub fn of(ack: &Ack) -> Self {
        Self {
            id: ack.id,
            tick: ack.tick,
            t_mono_ns: ack.t_mono_ns,
            result: match ack.outcome {
                Outcome::Applied => "applied",
                Outcome::Refused => "refused",
                Outcome::StaleEpoch => "epoch",
                Outcome::Malformed => "malformed",
                Outcome::Unsupported => "unsupported",
            },
            interlocks: ack.interlocks,
            state: state_name(ack.state),
        }
    }
}

#[derive(IntoPyObject)]
pub enum Detail {
    Flag(bool),
    Number(u64),
    Real(f64),
    Text(&'static str),
}

type Details = BTreeMap<&'static str, Detail>;

#[derive(IntoPyObject)]
pub struct EventDict {
    seq: u64,
    kind: &'static str,
    tick: u64,
    t_mono_ns: u64,
    details: Details,
}

impl EventDict {
    pub fn of(seq: u64, event: &ServoEvent) -> Self {
        let (kind, details) = details_of(&event.what);
        Self::new(seq, event, kind, details)
    }

    /// Stands for `lost` events that were overwritten before `event`.
    pub fn overflow(seq: u64, event: &ServoEvent, lost: u64) -> Self {
        let details = Details::from([("lost", Detail::Number(lost))]);
        Self::new(seq, event, "overflow", details)
    }

    fn new(seq: u64, event: &ServoEvent, kind: &'static str, details: Details) -> Self {
        Self {
            seq,
            kind,
            tick: event.tick,
            t_mono_ns: event.t_mono_ns,
            details,
        }
    }
}

fn details_of(what: &What) -> (&'static str, Details) {
    use Detail::{Flag, Number, Real, Text};
    let (kind, details) = match what {
        What::Started => ("started", vec![]),
        What::State { from, to } => {
            let (from, to) = (Text(state_name(*from)), Text(state_name(*to)));
            ("state", vec![("from", from), ("to", to)])
        }
        What::Faults { raised, latched } => {
            let (raised, latched) = (Number(*raised), Number(*latched));
            ("faults", vec![("raised", raised), ("latched", latched)])
        }
        What::Miss(miss) => ("miss", miss_details(miss)),
        What::Device { present } => {
            let link = if *present { "fresh" } else { "down" };
            ("device", vec![("link", Text(link))])
        }
        What::Front { alive } => ("front", vec![("alive", Flag(*alive))]),
        What::Passivity(control) => (
            "passivity",
            vec![
                ("wall", Number(control.wall)),
                ("acting", Flag(control.acting)),
                ("energy_j", Real(control.energy_j)),
                ("damping_n_s_per_m", Real(control.damping_n_s_per_m)),
            ],
        ),
        What::Garbled => ("garbled", vec![]),
        What::Stopped(reason) => ("stopped", vec![("reason", Text(stop_name(*reason)))]),
    };
    (kind, details.into_iter().collect())
}

/// The name of why a loop ended.
pub fn stop_name(reason: StopReason) -> &'static str {
    match reason {
        StopReason::Requested => "requested",
        StopReason::Orphaned => "orphaned",
    }
}

fn miss_details(miss: &Miss) -> Vec<(&'static str, Detail)> {
    let phase = match miss.part {
        TickPart::Wake => "wake",
        TickPart::Exchange => "exchange",
        TickPart::Compute => "compute",
        TickPart::Rest => "rest",
    };
    vec![
        ("skipped", Detail::Number(miss.skipped)),
        ("phase", Detail::Text(phase)),
        ("lateness_ns", Detail::Number(miss.lateness_ns)),
        ("exchange_ns", Detail::Number(miss.exchange_ns)),
        ("compute_ns", Detail::Number(miss.compute_ns)),
    ]
}

#[derive(IntoPyObject)]
pub struct HistogramDict {
    count: u64,
    sum_ns: u64,
    max_ns: u64,
    p50_ns: u64,
    p99_ns: u64,
    p999_ns: u64,
    edges_ns: Vec<u64>,
    counts: Vec<u64>,
}

impl HistogramDict {
    fn of(histogram: &Histogram) -> Self {
        Self {
            count: histogram.count,
            sum_ns: histogram.sum_ns,
            max_ns: histogram.max_ns,
            p50_ns: histogram.quantile_ns(0.5),
            p99_ns: histogram.quantile_ns(0.99),
            p999_ns: histogram.quantile_ns(0.999),
            edges_ns: (0..=BUCKETS).map(edge_ns).collect(),
            counts: histogram.counts.to_vec(),
        }
    }
}

#[derive(IntoPyObject)]
pub struct SchedulingDict {
    realtime: &'static str,
    realtime_ok: bool,
    policy: &'static str,
    priority: u8,
    cpu: Option<usize>,
    memory_locked: bool,
    problems: Vec<String>,
    selftest_samples: u64,
    selftest_median_ns: u64,
    selftest_p99_ns: u64,
    selftest_max_ns: u64,
}

impl SchedulingDict {
    fn of(status: &Status) -> Self {
        let obtained = &status.obtained;
        Self {
            realtime: match status.wish.realtime {
                Realtime::Off => "off",
                Realtime::Preferred => "preferred",
                Realtime::Required => "required",
            },
            realtime_ok: obtained.is_realtime(),
            policy: match obtained.policy {
                Policy::Other => "SCHED_OTHER",
                Policy::Fifo => "SCHED_FIFO",
                Policy::RoundRobin => "SCHED_RR",
            },
            priority: obtained.priority,
            cpu: obtained.cpu,
            memory_locked: obtained.memory_locked,
            problems: shortfalls(&status.wish, obtained),
            selftest_samples: obtained.self_test.samples,
            selftest_median_ns: obtained.self_test.median_ns,
            selftest_p99_ns: obtained.self_test.p99_ns,
            selftest_max_ns: obtained.self_test.max_ns,
        }
    }
}

#[derive(IntoPyObject)]
pub struct StatusDict {
    tick: u64,
    t_mono_ns: u64,
    state: &'static str,
    interlocks: u64,
    phase: &'static str,
    missed_ticks: u64,
    requests_applied: u64,
    identity: String,
    scheduling: SchedulingDict,
    lateness: HistogramDict,
    exchange: HistogramDict,
    compute: HistogramDict,
}

impl StatusDict {
    pub fn of(status: &Status, front: &Front) -> Self {
        Self {
            tick: status.tick,
            t_mono_ns: status.t_mono_ns,
            state: state_name(status.state),
            interlocks: status.interlocks,
            phase: match front.phase() {
                Phase::Starting => "starting",
                Phase::Running => "running",
                Phase::Stopping => "stopping",
                Phase::Stopped => "stopped",
            },
            missed_ticks: status.missed_ticks,
            requests_applied: status.requests_applied,
            identity: front.region().identity(),
            scheduling: SchedulingDict::of(status),
            lateness: HistogramDict::of(&status.timings.lateness),
            exchange: HistogramDict::of(&status.timings.exchange),
            compute: HistogramDict::of(&status.timings.compute),
        }
    }
}
