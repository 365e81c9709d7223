//! The shared file: created by the servo, attached by the front. The only unsafe code of the crate.

use crate::clock;
use crate::layout::{header, live, schema_hash, Layout, MAGIC, TEXT_WORDS, VERSION};
use crate::mailbox::{Receiver, Sender};
use crate::ring::{RingReader, RingWriter};
use crate::sync::{AtomicU64, Ordering};
use crate::text;
use crate::{ack, event, status};
use hapticd_control::record::RECORD_WORDS;
use memmap2::{MmapOptions, MmapRaw};
use nix::errno::Errno;
use nix::fcntl::{Flock, FlockArg};
use std::fs::{File, OpenOptions};
use std::io;
use std::ops::Range;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

/// Owner and group read and write: the front may run under another user of the same group.
const MODE: u32 = 0o660;

/// Why a region cannot be used.
#[derive(Debug)]
pub enum RegionError {
    /// The file system said no.
    Io(io::Error),
    /// Another servo runs on this file.
    ServoRunning(PathBuf),
    /// Another front holds this region.
    FrontAttached(PathBuf),
    /// The file is no region, or only a part of one.
    NotARegion(PathBuf),
    /// The file has another layout than this build.
    Version {
        /// Of the file.
        found: u64,
    },
    /// The file's tick records have other fields than this build.
    Schema {
        /// Of the file.
        found: u64,
    },
}

impl std::fmt::Display for RegionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(error) => write!(f, "{error}"),
            Self::ServoRunning(path) => {
                write!(f, "another servo runs on {}", path.display())
            }
            Self::FrontAttached(path) => {
                write!(f, "another front is attached to {}", path.display())
            }
            Self::NotARegion(path) => {
                write!(f, "{} is not a servo's shared memory", path.display())
            }
            Self::Version { found } => write!(
                f,
                "the servo's shared memory has layout {found}, this build reads layout {VERSION}: restart the servo with this build"
            ),
            Self::Schema { found } => write!(
                f,
                "the servo's tick records have schema {found:016x}, this build reads {:016x}: restart the servo with this build",
                schema_hash()
            ),
        }
    }
}

impl std::error::Error for RegionError {}

impl From<io::Error> for RegionError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// What the servo writes into the header.
#[derive(Clone, Debug)]
pub struct Identity<'a> {
    /// The device's id.
    pub device_id: &'a str,
    /// Rate of the loop, Hz.
    pub rate_hz: f64,
    /// Whether the device is a twin.
    pub twin: bool,
}

/// The header as read back.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// The device's id.
    pub device_id: String,
    /// Rate of the loop, Hz.
    pub rate_hz: f64,
    /// Whether the device is a twin.
    pub twin: bool,
    /// Process id of the servo.
    pub pid: u32,
    /// UTC at its start, ns.
    pub started_utc_ns: u64,
    /// `CLOCK_MONOTONIC` at its start, ns.
    pub started_mono_ns: u64,
    /// Boot it started in.
    pub boot_id: u128,
}

/// One servo's shared memory, mapped into this process.
pub struct Region {
    map: MmapRaw,
    layout: Layout,
    /// Held as long as the region: it marks the one servo or the one front.
    _claim: Option<Flock<File>>,
}

impl Region {
    /// A fresh region at `path`, published by renaming: nobody ever sees a half-written header, and
    /// readers of a predecessor keep its last ticks.
    ///
    /// # Errors
    /// [`RegionError`] when a servo already runs there or the file cannot be made.
    pub fn create(path: &Path, identity: &Identity<'_>) -> Result<Self, RegionError> {
        let lock = open(&with_suffix(path, ".lock"), true)?;
        let claim = claim(lock).map_err(|busy| match busy {
            None => RegionError::ServoRunning(path.into()),
            Some(error) => error.into(),
        })?;
        let layout = Layout::for_rate(identity.rate_hz);
        let unpublished = with_suffix(path, ".new");
        let file = open(&unpublished, true)?;
        file.set_len(0)?;
        file.set_len(layout.words as u64 * 8)?;
        let region = Self {
            map: MmapOptions::new().map_raw(&file)?,
            layout,
            _claim: Some(claim),
        };
        region.write_header(identity);
        std::fs::rename(&unpublished, path)?;
        Ok(region)
    }

    /// The region at `path`. With `front`, claimed as its only front.
    ///
    /// # Errors
    /// [`RegionError`] when it is missing, of another layout, or has a front already.
    pub fn attach(path: &Path, front: bool) -> Result<Self, RegionError> {
        let file = open(path, false)?;
        let map = MmapOptions::new().map_raw(&file)?;
        let layout = check(path, &map)?;
        let claim = front.then(|| claim(file)).transpose();
        let claim = claim.map_err(|busy| match busy {
            None => RegionError::FrontAttached(path.into()),
            Some(error) => error.into(),
        })?;
        Ok(Self {
            map,
            layout,
            _claim: claim,
        })
    }

    fn write_header(&self, identity: &Identity<'_>) {
        let boot = boot_id();
        let fields = [
            (header::VERSION, VERSION),
            (header::SCHEMA, schema_hash()),
            (header::TICK_CAPACITY, self.layout.tick_capacity as u64),
            (header::RATE, identity.rate_hz.to_bits()),
            (header::PID, u64::from(std::process::id())),
            (header::STARTED_UTC_NS, clock::utc_ns()),
            (header::STARTED_MONO_NS, clock::monotonic_ns()),
            (header::BOOT_ID.start, (boot >> 64) as u64),
            (header::BOOT_ID.start + 1, boot as u64),
            (header::TWIN, u64::from(identity.twin)),
            // A front that attaches before the first tick finds the servo alive.
            (live::SERVO_HEARTBEAT, clock::monotonic_ns()),
            (header::MAGIC, MAGIC),
        ];
        for (at, value) in fields {
            self.word(at).store(value, Ordering::Relaxed);
        }
        let id = text::encode::<TEXT_WORDS>(identity.device_id);
        crate::sync::store(self.section(&header::DEVICE_ID), &id);
    }

    /// The header.
    #[must_use]
    pub fn info(&self) -> Info {
        let word = |at| self.word(at).load(Ordering::Relaxed);
        let mut id = [0; TEXT_WORDS];
        crate::sync::load(self.section(&header::DEVICE_ID), &mut id);
        let high = u128::from(word(header::BOOT_ID.start));
        Info {
            device_id: text::decode(&id),
            rate_hz: f64::from_bits(word(header::RATE)),
            twin: word(header::TWIN) != 0,
            pid: word(header::PID) as u32,
            started_utc_ns: word(header::STARTED_UTC_NS),
            started_mono_ns: word(header::STARTED_MONO_NS),
            boot_id: high << 64 | u128::from(word(header::BOOT_ID.start + 1)),
        }
    }

    /// Where everything lies.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    fn words(&self) -> &[AtomicU64] {
        atomics(&self.map)
    }

    fn section(&self, range: &Range<usize>) -> &[AtomicU64] {
        &self.words()[range.clone()]
    }

    /// One word of the header.
    pub(crate) fn word(&self, at: usize) -> &AtomicU64 {
        &self.words()[at]
    }

    /// Writer of the ticks. The servo's loop has it.
    pub(crate) fn tick_writer(&self) -> RingWriter<'_> {
        RingWriter::over(self.section(&self.layout.ticks), RECORD_WORDS)
    }

    /// Reader of the ticks.
    #[must_use]
    pub fn ticks(&self) -> RingReader<'_> {
        RingReader::over(self.section(&self.layout.ticks), RECORD_WORDS)
    }

    /// Sender of requests. The front has it.
    pub(crate) fn request_sender(&self) -> Sender<'_> {
        Sender::over(self.section(&self.layout.requests))
    }

    /// Receiver of requests. The servo's loop has it.
    pub(crate) fn request_receiver(&self) -> Receiver<'_> {
        Receiver::over(self.section(&self.layout.requests))
    }

    /// Writer of acks. The servo's loop has it.
    pub(crate) fn ack_writer(&self) -> RingWriter<'_> {
        RingWriter::over(self.section(&self.layout.acks), ack::ACK_WORDS)
    }

    /// Reader of acks.
    #[must_use]
    pub fn acks(&self) -> RingReader<'_> {
        RingReader::over(self.section(&self.layout.acks), ack::ACK_WORDS)
    }

    /// Writer of events. The servo's loop has it.
    pub(crate) fn event_writer(&self) -> RingWriter<'_> {
        RingWriter::over(self.section(&self.layout.events), event::EVENT_WORDS)
    }

    /// Reader of events.
    #[must_use]
    pub fn events(&self) -> RingReader<'_> {
        RingReader::over(self.section(&self.layout.events), event::EVENT_WORDS)
    }

    /// Writer of the status. The servo's loop has it.
    pub(crate) fn status_writer(&self) -> RingWriter<'_> {
        RingWriter::over(self.section(&self.layout.status), status::STATUS_WORDS)
    }

    /// Reader of the status.
    #[must_use]
    pub fn status(&self) -> RingReader<'_> {
        RingReader::over(self.section(&self.layout.status), status::STATUS_WORDS)
    }

    /// Says what is connected. Only the servo's parked main thread calls it.
    pub fn set_identity(&self, identity: &str) {
        let section = self.section(&self.layout.identity);
        RingWriter::over(section, TEXT_WORDS).publish(&text::encode::<TEXT_WORDS>(identity));
    }

    /// What is connected, empty before the first connection.
    #[must_use]
    pub fn identity(&self) -> String {
        let mut words = [0; TEXT_WORDS];
        RingReader::over(self.section(&self.layout.identity), TEXT_WORDS)
            .latest(&mut words)
            .map_or_else(String::new, |_| text::decode(&words))
    }

    /// `CLOCK_MONOTONIC` of the servo's last tick, ns.
    #[must_use]
    pub fn servo_heartbeat_ns(&self) -> u64 {
        self.word(live::SERVO_HEARTBEAT).load(Ordering::Relaxed)
    }
}

/// A mapping's words.
fn atomics(map: &MmapRaw) -> &[AtomicU64] {
    // SAFETY: a mapping starts on a page, so it is aligned for u64; it is `map.len()` bytes long and
    // lives as long as `map`, to which the returned lifetime is bound; every bit pattern is a valid
    // u64; and all processes reach the file through this function, so every access is atomic. A
    // process that shrinks the file takes its readers down by SIGBUS: the file's mode leaves that
    // to the servo's own user and group, and nothing in hapticd does it.
    unsafe { std::slice::from_raw_parts(map.as_ptr().cast(), map.len() / 8) }
}

/// The layout of the file at `path`, if this build can use it.
fn check(path: &Path, map: &MmapRaw) -> Result<Layout, RegionError> {
    let not_a_region = || RegionError::NotARegion(path.into());
    let words = atomics(map);
    let word = |at: usize| words.get(at).map_or(0, |word| word.load(Ordering::Relaxed));
    if word(header::MAGIC) != MAGIC {
        return Err(not_a_region());
    }
    if word(header::VERSION) != VERSION {
        let found = word(header::VERSION);
        return Err(RegionError::Version { found });
    }
    if word(header::SCHEMA) != schema_hash() {
        let found = word(header::SCHEMA);
        return Err(RegionError::Schema { found });
    }
    let capacity = word(header::TICK_CAPACITY) as usize;
    if capacity == 0 || capacity > words.len() {
        return Err(not_a_region());
    }
    let layout = Layout::new(capacity);
    if layout.words != words.len() {
        return Err(not_a_region());
    }
    Ok(layout)
}

fn open(path: &Path, create: bool) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(create).mode(MODE);
    options.open(path)
}

/// Locks `file` for this process's life; `Err(None)` when somebody else has it.
fn claim(file: File) -> Result<Flock<File>, Option<io::Error>> {
    Flock::lock(file, FlockArg::LockExclusiveNonblock).map_err(|(_, errno)| match errno {
        Errno::EWOULDBLOCK => None,
        other => Some(other.into()),
    })
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// The kernel's id of this boot; 0 where there is none.
#[must_use]
pub fn boot_id() -> u128 {
    std::fs::read_to_string("/proc/sys/kernel/random/boot_id")
        .ok()
        .and_then(|text| u128::from_str_radix(&text.trim().replace('-', ""), 16).ok())
        .unwrap_or(0)
}
