//! The front's side of a region.

use crate::clock::{monotonic_ns, SECOND_NS};
use crate::layout::live;
use crate::mailbox::Full;
use crate::region::{boot_id, Region, RegionError};
use crate::request::{Envelope, Request, REQUEST_WORDS};
use crate::status::Phase;
use crate::sync::Ordering;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A servo whose heartbeat is older than this counts as dead.
const SERVO_SILENCE_NS: u64 = SECOND_NS / 2;

/// Why a request was not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SendError {
    /// The queue is full: the servo is slow or gone.
    Full,
    /// This side only observes.
    Observer,
}

/// A region as its front, or as an observer that only reads.
pub struct Front {
    region: Region,
    is_front: bool,
    /// Makes the threads of this process one sender.
    sending: Mutex<()>,
}

impl Front {
    /// Attaches to the region at `path`. There is one front at a time, and any number of observers.
    ///
    /// # Errors
    /// [`RegionError`] when it is missing, of another layout, or has a front already.
    pub fn attach(path: &Path, observe: bool) -> Result<Self, RegionError> {
        let front = Self {
            region: Region::attach(path, !observe)?,
            is_front: !observe,
            sending: Mutex::new(()),
        };
        if front.is_front {
            let pid = u64::from(std::process::id());
            front.store(live::FRONT_PID, pid);
        }
        Ok(front)
    }

    /// The shared memory.
    #[must_use]
    pub fn region(&self) -> &Region {
        &self.region
    }

    fn store(&self, at: usize, value: u64) {
        self.region.word(at).store(value, Ordering::Relaxed);
    }

    fn load(&self, at: usize) -> u64 {
        self.region.word(at).load(Ordering::Acquire)
    }

    /// Shows the servo that the front is alive.
    ///
    /// # Errors
    /// [`SendError::Observer`] when this side only observes.
    pub fn heartbeat(&self) -> Result<(), SendError> {
        self.heartbeat_at(monotonic_ns())
    }

    /// The same for a loop whose clock is not the kernel's.
    ///
    /// # Errors
    /// [`SendError::Observer`] when this side only observes.
    pub fn heartbeat_at(&self, now_ns: u64) -> Result<(), SendError> {
        if !self.is_front {
            return Err(SendError::Observer);
        }
        self.store(live::FRONT_HEARTBEAT, now_ns);
        Ok(())
    }

    /// Queues a request and returns its number: 1 for the first one a servo ever gets.
    ///
    /// # Errors
    /// [`SendError`] when it was not queued.
    pub fn send(&self, request: Request, epoch: Option<u64>) -> Result<u64, SendError> {
        if !self.is_front {
            return Err(SendError::Observer);
        }
        let _alone = self.sending.lock().unwrap_or_else(PoisonError::into_inner);
        let id = self.load(live::LAST_REQUEST) + 1;
        let envelope = Envelope { id, epoch, request };
        let mut words = [0; REQUEST_WORDS];
        let length = envelope.encode(&mut words);
        let sent = self.region.request_sender().send(&words[..length]);
        sent.map_err(|Full| SendError::Full)?;
        self.store(live::LAST_REQUEST, id);
        Ok(id)
    }

    /// Where in its life the servo is, as it last said.
    #[must_use]
    pub fn phase(&self) -> Phase {
        Phase::from_word(self.load(live::PHASE))
    }

    /// Whether the servo ticks: it belongs to this boot, has not stopped, and beat lately.
    #[must_use]
    pub fn servo_alive(&self) -> bool {
        let silence_ns = monotonic_ns().saturating_sub(self.region.servo_heartbeat_ns());
        silence_ns < SERVO_SILENCE_NS
            && self.phase() != Phase::Stopped
            && self.region.info().boot_id == boot_id()
    }
}
