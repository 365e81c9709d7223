//! Real-time scheduling: what is asked for, and what the kernel really gave.

use crate::clock::Clock;
use crate::histogram::Histogram;
use nix::sched::{sched_getaffinity, sched_setaffinity, CpuSet};
use nix::sys::mman::{mlockall, MlockAllFlags};
use nix::sys::signal::SigSet;
use nix::unistd::Pid;
use serde::Deserialize;
use thread_priority::{
    set_thread_priority_and_policy, thread_native_id, thread_schedule_policy_param,
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
};

/// How much the device needs real-time scheduling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Realtime {
    /// Not asked for.
    Off,
    /// Asked for; the device also renders without.
    #[default]
    Preferred,
    /// Asked for; without it the device cannot be enabled.
    Required,
}

/// What is asked of the kernel.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    /// Whether to ask at all.
    pub realtime: Realtime,
    /// `SCHED_FIFO` priority, 1 to 99.
    pub priority: u8,
    /// CPU to stay on.
    pub cpu: Option<usize>,
}

/// Scheduling policy of a thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Policy {
    /// Any that is not real-time.
    #[default]
    Other,
    /// `SCHED_FIFO`.
    Fifo,
    /// `SCHED_RR`.
    RoundRobin,
}

/// Wake-up lateness of short sleeps, measured before the first tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTest {
    /// Sleeps measured.
    pub samples: u64,
    /// Median, ns.
    pub median_ns: u64,
    /// 99th percentile, ns.
    pub p99_ns: u64,
    /// Longest, ns.
    pub max_ns: u64,
}

/// What the kernel gave, read back from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Obtained {
    /// Policy in force.
    pub policy: Policy,
    /// Priority in force.
    pub priority: u8,
    /// CPU the thread is pinned to.
    pub cpu: Option<usize>,
    /// All memory of the process is locked.
    pub memory_locked: bool,
    /// The lateness that came with it.
    pub self_test: SelfTest,
}

impl Obtained {
    /// Whether the thread is real-time and its memory locked.
    #[must_use]
    pub fn is_realtime(&self) -> bool {
        self.policy != Policy::Other && self.memory_locked
    }

    /// Whether this is enough to enable the device.
    #[must_use]
    pub fn satisfies(&self, realtime: Realtime) -> bool {
        realtime != Realtime::Required || self.is_realtime()
    }
}

/// Asks the kernel for `wish` on the calling thread and reads back what it gave. A refusal is not
/// an error: the difference between wish and [`Obtained`] is the report.
pub fn obtain(wish: &Wish) -> Obtained {
    // Signals belong to the parked main thread: none may interrupt the loop.
    let _ = SigSet::all().thread_block();
    if let Some(cpu) = wish.cpu {
        pin(cpu);
    }
    let memory_locked = wish.realtime != Realtime::Off && lock_memory();
    if wish.realtime != Realtime::Off {
        become_fifo(wish.priority);
    }
    let (policy, priority) = policy_in_force();
    Obtained {
        policy,
        priority,
        cpu: pinned_to(),
        memory_locked,
        self_test: SelfTest::default(),
    }
}

fn pin(cpu: usize) {
    let mut set = CpuSet::new();
    if set.set(cpu).is_ok() {
        let _ = sched_setaffinity(Pid::from_raw(0), &set);
    }
}

/// The only CPU the thread may run on, if there is only one.
fn pinned_to() -> Option<usize> {
    let set = sched_getaffinity(Pid::from_raw(0)).ok()?;
    let mut allowed = (0..CpuSet::count()).filter(|cpu| set.is_set(*cpu).unwrap_or(false));
    allowed.next().filter(|_| allowed.next().is_none())
}

fn lock_memory() -> bool {
    mlockall(MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE).is_ok()
}

fn become_fifo(priority: u8) {
    if let Ok(value) = ThreadPriorityValue::try_from(priority) {
        let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        let priority = ThreadPriority::Crossplatform(value);
        let _ = set_thread_priority_and_policy(thread_native_id(), priority, fifo);
    }
}

fn policy_in_force() -> (Policy, u8) {
    let Ok((policy, parameters)) = thread_schedule_policy_param(thread_native_id()) else {
        return (Policy::Other, 0);
    };
    let policy = match policy {
        ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo) => Policy::Fifo,
        ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::RoundRobin) => {
            Policy::RoundRobin
        }
        _ => Policy::Other,
    };
    let priority = u8::try_from(parameters.sched_priority).unwrap_or(0);
    (policy, priority)
}

/// Sleeps `samples` times for `period_ns` and measures how late it wakes up.
pub fn measure(clock: &mut impl Clock, samples: u64, period_ns: u64) -> SelfTest {
    let mut lateness = Histogram::default();
    for _ in 0..samples {
        let deadline_ns = clock.now_ns() + period_ns;
        clock.sleep_until_ns(deadline_ns);
        lateness.record(clock.now_ns().saturating_sub(deadline_ns));
    }
    SelfTest {
        samples,
        median_ns: lateness.quantile_ns(0.5),
        p99_ns: lateness.quantile_ns(0.99),
        max_ns: lateness.max_ns,
    }
}

/// Why `obtained` falls short of `wish`, one sentence each with its cure.
#[must_use]
pub fn shortfalls(wish: &Wish, obtained: &Obtained) -> Vec<String> {
    let mut problems = Vec::new();
    if wish.realtime != Realtime::Off && obtained.policy != Policy::Fifo {
        problems.push(format!(
            "SCHED_FIFO {} was refused: raise RLIMIT_RTPRIO (LimitRTPRIO= in systemd, rtprio in limits.d) or give CAP_SYS_NICE.",
            wish.priority
        ));
    }
    if wish.realtime != Realtime::Off && !obtained.memory_locked {
        problems.push(
            "Locking memory was refused: raise RLIMIT_MEMLOCK (LimitMEMLOCK=infinity in systemd) or give CAP_IPC_LOCK.".into(),
        );
    }
    if let Some(cpu) = wish.cpu.filter(|cpu| obtained.cpu != Some(*cpu)) {
        problems.push(format!(
            "Pinning to CPU {cpu} was refused: choose one that exists and that the service's CPU set allows."
        ));
    }
    problems
}
