//! Where the main thread waits while the real-time thread runs.

use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::AsRawFd;
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

/// Nobody has been told that the driver is down.
const DOWN: u8 = 0;
/// The main thread is connecting the driver.
const CONNECTING: u8 = 1;
/// The loop may call the driver.
const READY: u8 = 2;

/// Why the main thread is woken. The number is of no meaning: signals arrive on the same stream.
#[derive(Clone, Copy)]
pub enum Wake {
    /// The driver is down.
    Down = 1,
    /// The loop ended.
    Ended = 2,
}

/// What the two threads share.
pub struct Parking {
    waker: UnixStream,
    sleeper: UnixStream,
    driver: AtomicU8,
    driver_error: Mutex<Option<String>>,
    ended: Mutex<Option<String>>,
}

impl Parking {
    /// A parking place; `has_driver` when there is a driver to be connected.
    pub fn new(has_driver: bool) -> io::Result<Self> {
        let (waker, sleeper) = UnixStream::pair()?;
        waker.set_nonblocking(true)?;
        Ok(Self {
            waker,
            sleeper,
            driver: AtomicU8::new(if has_driver { DOWN } else { READY }),
            driver_error: Mutex::new(None),
            ended: Mutex::new(None),
        })
    }

    /// The descriptor that wakes the sleeper when something is written to it.
    pub fn wake_fd(&self) -> i32 {
        self.waker.as_raw_fd()
    }

    /// Wakes the sleeper. A full stream is no loss: the sleeper is awake then.
    pub fn wake(&self, wake: Wake) {
        let _ = (&self.waker).write(&[wake as u8]);
    }

    /// Sleeps until somebody wakes it or a signal arrives.
    pub fn sleep(&self) -> io::Result<()> {
        let mut wakes = [0; 64];
        match (&self.sleeper).read(&mut wakes) {
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            other => other.map(|_| ()),
        }
    }

    /// Whether the loop may call the driver.
    pub fn driver_is_ready(&self) -> bool {
        self.driver.load(Ordering::Acquire) == READY
    }

    /// The main thread has connected the driver.
    pub fn driver_ready(&self) {
        self.driver.store(READY, Ordering::Release);
    }

    /// The loop found the driver down.
    pub fn driver_lost(&self, why: Option<String>) {
        if why.is_some() {
            *self
                .driver_error
                .lock()
                .unwrap_or_else(PoisonError::into_inner) = why;
        }
        self.driver.store(DOWN, Ordering::Release);
    }

    /// Whether the driver is down and nobody has taken it on; from now on somebody has.
    pub fn take_down(&self) -> bool {
        let taken =
            self.driver
                .compare_exchange(DOWN, CONNECTING, Ordering::AcqRel, Ordering::Acquire);
        taken.is_ok()
    }

    /// What the driver raised last.
    pub fn driver_error(&self) -> Option<String> {
        let error = self
            .driver_error
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        error.clone()
    }

    /// The loop ended like this.
    pub fn end(&self, how: String) {
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(how);
        self.wake(Wake::Ended);
    }

    /// How the loop ended, if it has.
    pub fn ended(&self) -> Option<String> {
        self.ended
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}
