//! How a loop ends: fade first, then stop, in bounded time.

use crate::clock::SECOND_NS;
use crate::event::StopReason;

/// Outputs get this long to fade. Longer than any model's `fade_s`, shorter than a supervisor waits.
const FADE_LIMIT_NS: u64 = SECOND_NS * 3 / 2;

/// Whether and why the loop is ending.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ending {
    begun: Option<(StopReason, u64)>,
}

impl Ending {
    /// Begins to end; true the first time only.
    pub fn begin(&mut self, reason: StopReason, now_ns: u64) -> bool {
        let first = self.begun.is_none();
        self.begun.get_or_insert((reason, now_ns));
        first
    }

    /// Why the loop may stop now: its outputs are off, or had their time.
    #[must_use]
    pub fn due(&self, outputs_on: bool, now_ns: u64) -> Option<StopReason> {
        let (reason, begun_ns) = self.begun?;
        let expired = now_ns >= begun_ns + FADE_LIMIT_NS;
        (expired || !outputs_on).then_some(reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_waits_for_the_outputs_but_not_for_ever() {
        let mut ending = Ending::default();
        assert_eq!(ending.due(false, 0), None);
        assert!(ending.begin(StopReason::Orphaned, 10));
        assert!(!ending.begin(StopReason::Requested, 20));
        assert_eq!(ending.due(true, 30), None);
        assert_eq!(ending.due(false, 30), Some(StopReason::Orphaned));
        let late_ns = 10 + FADE_LIMIT_NS;
        assert_eq!(ending.due(true, late_ns - 1), None);
        assert_eq!(ending.due(true, late_ns), Some(StopReason::Orphaned));
    }
}
