//! The monotonic clock, and sleeping on it.

use nix::errno::Errno;
use nix::sys::time::TimeSpec;
use nix::time::{clock_gettime, clock_nanosleep, ClockId, ClockNanosleepFlags};

/// Nanoseconds of one second.
pub const SECOND_NS: u64 = 1_000_000_000;

/// Time as the loop sees it. Tests drive the loop on a clock of their own.
pub trait Clock {
    /// Now, ns.
    fn now_ns(&mut self) -> u64;
    /// Returns at `deadline_ns` or, when that has passed, at once.
    fn sleep_until_ns(&mut self, deadline_ns: u64);
}

/// `CLOCK_MONOTONIC` of the kernel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Monotonic;

impl Clock for Monotonic {
    fn now_ns(&mut self) -> u64 {
        clock_ns(ClockId::CLOCK_MONOTONIC)
    }

    fn sleep_until_ns(&mut self, deadline_ns: u64) {
        let seconds = (deadline_ns / SECOND_NS) as i64;
        let deadline = TimeSpec::new(seconds, (deadline_ns % SECOND_NS) as i64);
        while clock_nanosleep(
            ClockId::CLOCK_MONOTONIC,
            ClockNanosleepFlags::TIMER_ABSTIME,
            &deadline,
        ) == Err(Errno::EINTR)
        {}
    }
}

/// A kernel clock's time, ns. Linux always has the clocks asked for here.
fn clock_ns(clock: ClockId) -> u64 {
    clock_gettime(clock).map_or(0, |time| {
        time.tv_sec() as u64 * SECOND_NS + time.tv_nsec() as u64
    })
}

/// `CLOCK_MONOTONIC`, ns: the same in every process of this boot.
#[must_use]
pub fn monotonic_ns() -> u64 {
    clock_ns(ClockId::CLOCK_MONOTONIC)
}

/// UTC, ns since 1970.
#[must_use]
pub fn utc_ns() -> u64 {
    clock_ns(ClockId::CLOCK_REALTIME)
}
