//! Epochs of the lease: a request made under a superseded lease is refused.

/// The newest epoch seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct LeaseGuard {
    newest: u64,
}

impl LeaseGuard {
    /// Whether a request of this epoch may pass. A newer epoch supersedes the older ones at once; a
    /// request without one was made while nobody held the lease, which the front has checked.
    pub fn admits(&mut self, epoch: Option<u64>) -> bool {
        let epoch = epoch.unwrap_or(self.newest);
        self.newest = self.newest.max(epoch);
        epoch == self.newest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_superseded_epoch_never_passes_again() {
        let mut guard = LeaseGuard::default();
        assert!(guard.admits(Some(3)));
        assert!(guard.admits(Some(5)));
        assert!(!guard.admits(Some(3)));
        assert!(!guard.admits(Some(4)));
        assert!(guard.admits(Some(5)));
    }

    #[test]
    fn requests_without_a_lease_pass_and_supersede_nothing() {
        let mut guard = LeaseGuard::default();
        assert!(guard.admits(Some(3)));
        assert!(guard.admits(None));
        assert!(guard.admits(Some(3)));
    }
}
