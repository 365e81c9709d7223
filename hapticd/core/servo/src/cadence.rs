//! When the next tick is due.

/// Absolute deadlines on a fixed grid. After an overrun the grid points that passed are skipped
/// and counted, never made up for in a burst.
#[derive(Clone, Copy, Debug)]
pub struct Cadence {
    period_ns: u64,
    deadline_ns: u64,
}

impl Cadence {
    /// The first deadline is one period after `now_ns`.
    #[must_use]
    pub fn new(period_ns: u64, now_ns: u64) -> Self {
        Self {
            period_ns,
            deadline_ns: now_ns + period_ns,
        }
    }

    /// The deadline of the tick that is due or running, ns.
    #[must_use]
    pub fn deadline_ns(&self) -> u64 {
        self.deadline_ns
    }

    /// Moves on to the next deadline. If that has passed, to the first grid point at least half a
    /// period after `now_ns`, so that an overrun is never followed by a tick at its heels. Returns
    /// how many deadlines were skipped.
    pub fn advance(&mut self, now_ns: u64) -> u64 {
        self.deadline_ns += self.period_ns;
        if now_ns < self.deadline_ns {
            return 0;
        }
        let late_ns = now_ns + self.period_ns / 2 - self.deadline_ns;
        let skipped = late_ns.div_ceil(self.period_ns).max(1);
        self.deadline_ns += skipped * self.period_ns;
        skipped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PERIOD_NS: u64 = 1000;

    #[test]
    fn a_tick_that_ends_just_in_time_misses_nothing() {
        let mut cadence = Cadence::new(PERIOD_NS, 0);
        assert_eq!(cadence.advance(1999), 0);
        assert_eq!(cadence.deadline_ns(), 2000);
    }

    #[test]
    fn an_overrun_skips_its_deadline_and_leaves_half_a_period() {
        let mut cadence = Cadence::new(PERIOD_NS, 0);
        assert_eq!(cadence.advance(2600), 2);
        assert_eq!(cadence.deadline_ns(), 4000);
    }

    proptest! {
        #[test]
        fn deadlines_stay_on_the_grid_and_are_never_made_up_for(
            busy in prop::collection::vec(0u64..5 * PERIOD_NS, 1..50)
        ) {
            let mut cadence = Cadence::new(PERIOD_NS, 0);
            let mut skipped = 0;
            for (ticks, busy_ns) in busy.iter().enumerate() {
                let end_ns = cadence.deadline_ns() + busy_ns;
                let missed = cadence.advance(end_ns);
                skipped += missed;
                prop_assert!(cadence.deadline_ns() > end_ns);
                prop_assert_eq!(missed > 0, *busy_ns >= PERIOD_NS);
                if missed > 0 {
                    prop_assert!(cadence.deadline_ns() - end_ns >= PERIOD_NS / 2);
                    prop_assert!(cadence.deadline_ns() - end_ns <= PERIOD_NS + PERIOD_NS / 2);
                }
                let grid_points = ticks as u64 + 2 + skipped;
                prop_assert_eq!(cadence.deadline_ns(), grid_points * PERIOD_NS);
            }
        }
    }
}
