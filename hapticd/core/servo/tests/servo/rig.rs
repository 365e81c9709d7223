//! A loop on a test's own clock and driver: a twin whose exchanges a script watches and changes.

use hapticd_control::controller::Controller;
use hapticd_control::io::{Command, Exchange, Observation};
use hapticd_control::model::DeviceModel;
use hapticd_control::record::{FIELDS, RECORD_WORDS};
use hapticd_servo::ack::Ack;
use hapticd_servo::clock::{Clock, SECOND_NS};
use hapticd_servo::document::parse;
use hapticd_servo::driver::{Driver, TwinFace};
use hapticd_servo::event::{ServoEvent, StopReason, What};
use hapticd_servo::front::Front;
use hapticd_servo::port::Port;
use hapticd_servo::region::{Identity, Region};
use hapticd_servo::ring::RingReader;
use hapticd_servo::run::{Loop, Terms};
use hapticd_servo::scheduling::{Obtained, Realtime, Wish};
use hapticd_servo::twin_driver::TwinDriver;
use hapticd_twin::{Twin, TwinModel};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Arc;
use tempfile::TempDir;

pub const RATE_HZ: f64 = 1000.0;
pub const PERIOD_NS: u64 = SECOND_NS / 1000;
/// Past the front's patience of every model.
pub const SILENCE_NS: u64 = 10 * SECOND_NS;

/// Any model with its twin, as shipped.
pub fn models(text: &str) -> (DeviceModel, TwinModel) {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    let twin = table.remove("twin").expect("device file has a twin");
    let device = table.try_into().expect("device file matches the model");
    (
        device,
        twin.try_into().expect("device file matches the twin"),
    )
}

pub fn phantom() -> (DeviceModel, TwinModel) {
    models(include_str!("../../../../devices/phantom-1.0.toml"))
}

/// Time that passes only when somebody says so.
#[derive(Clone, Default)]
pub struct TestClock(Arc<AtomicU64>);

impl TestClock {
    pub fn spend(&self, duration_ns: u64) {
        self.0.fetch_add(duration_ns, Ordering::Relaxed);
    }
}

impl Clock for TestClock {
    fn now_ns(&mut self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    fn sleep_until_ns(&mut self, deadline_ns: u64) {
        self.0.fetch_max(deadline_ns, Ordering::Relaxed);
    }
}

/// One exchange, as the script sees it.
pub struct Moment<'a> {
    pub n: u64,
    pub command: Command,
    pub front: &'a Front,
    pub stop: &'a AtomicBool,
    pub clock: &'a TestClock,
    /// What the loop will be given; the twin's answer unless the script changes it.
    pub reply: Exchange,
    /// Whether the front beats at this tick.
    pub beat: bool,
}

impl Moment<'_> {
    pub fn send(&self, json: &str) -> u64 {
        let (request, epoch) = parse(json).expect("a valid request");
        self.front.send(request, epoch).expect("room in the queue")
    }
}

struct ScriptedDriver<F> {
    n: u64,
    twin: TwinDriver,
    has_twin: bool,
    front: Front,
    clock: TestClock,
    stop: Arc<AtomicBool>,
    script: F,
}

impl<F: FnMut(&mut Moment<'_>) + Send> Driver for ScriptedDriver<F> {
    fn exchange(&mut self, command: &Command, observation: &mut Observation) -> Exchange {
        let mut latest = *observation;
        let mut moment = Moment {
            n: self.n,
            command: *command,
            front: &self.front,
            stop: &self.stop,
            clock: &self.clock,
            reply: self.twin.exchange(command, &mut latest),
            beat: true,
        };
        (self.script)(&mut moment);
        if moment.beat {
            let now_ns = self.clock.clone().now_ns();
            self.front.heartbeat_at(now_ns).expect("this is the front");
        }
        if moment.reply == Exchange::Fresh {
            *observation = latest;
        }
        self.n += 1;
        moment.reply
    }

    fn twin(&mut self) -> Option<&mut dyn TwinFace> {
        self.has_twin.then_some(&mut self.twin as &mut dyn TwinFace)
    }
}

/// A region, and what the loop on it is told.
pub struct Rig {
    _directory: TempDir,
    region: Region,
    path: PathBuf,
    pub realtime: Realtime,
    pub orphan_ns: Option<u64>,
    pub has_twin: bool,
}

/// What a loop left behind.
pub struct Report {
    pub reason: StopReason,
    pub ticks: Vec<[u64; RECORD_WORDS]>,
    pub acks: Vec<Ack>,
    pub events: Vec<ServoEvent>,
}

impl Rig {
    pub fn new() -> Self {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let path = directory.path().join("rig.shm");
        let identity = Identity {
            device_id: "rig",
            rate_hz: RATE_HZ,
            twin: true,
        };
        Self {
            region: Region::create(&path, &identity).expect("a region"),
            _directory: directory,
            path,
            realtime: Realtime::Off,
            orphan_ns: None,
            has_twin: true,
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Runs a PHANTOM until the script sets `stop` or the loop ends by itself.
    pub fn run(&self, script: impl FnMut(&mut Moment<'_>) + Send) -> Report {
        self.run_guarded(|run| run(), script)
    }

    /// The same with the loop itself, and nothing else, inside `guard`.
    pub fn run_guarded(
        &self,
        guard: impl FnOnce(&mut dyn FnMut() -> StopReason) -> StopReason,
        script: impl FnMut(&mut Moment<'_>) + Send,
    ) -> Report {
        let (device, twin) = phantom();
        let clock = TestClock::default();
        clock.spend(SECOND_NS);
        let stop = Arc::new(AtomicBool::new(false));
        let driver = ScriptedDriver {
            n: 0,
            twin: TwinDriver::new(Twin::new(&device, &twin, RATE_HZ, 1).expect("a twin")),
            has_twin: self.has_twin,
            front: Front::attach(&self.path, false).expect("the front"),
            clock: clock.clone(),
            stop: Arc::clone(&stop),
            script,
        };
        let controller = Controller::new(&device, RATE_HZ).expect("a controller");
        let port = Port::new(&self.region);
        let terms = self.terms(&device);
        let mut looping = Loop::new(terms, controller, driver, port, clock);
        let reason = guard(&mut || looping.run(&stop));
        self.report(reason)
    }

    fn terms(&self, device: &DeviceModel) -> Terms {
        Terms {
            rate_hz: RATE_HZ,
            heartbeat_ns: (device.limits.heartbeat_s * 1e9) as u64,
            orphan_ns: self.orphan_ns,
            wish: Wish {
                realtime: self.realtime,
                priority: 80,
                cpu: None,
            },
            obtained: Obtained::default(),
        }
    }

    fn report(&self, reason: StopReason) -> Report {
        let events = all(&self.region.events());
        let acks = all(&self.region.acks());
        Report {
            reason,
            ticks: all(&self.region.ticks())
                .into_iter()
                .map(|words| words.try_into().expect("a record"))
                .collect(),
            acks: acks.iter().filter_map(|words| Ack::decode(words)).collect(),
            events: events
                .iter()
                .filter_map(|words| ServoEvent::decode(words))
                .collect(),
        }
    }
}

impl Report {
    /// One scalar field of one tick.
    pub fn field(&self, tick: usize, name: &str) -> u64 {
        self.ticks[tick][word_of(name)]
    }

    /// One vector field of one tick.
    pub fn axes(&self, tick: usize, name: &str) -> [f64; 3] {
        [0, 1, 2].map(|axis| f64::from_bits(self.ticks[tick][word_of(name) + axis]))
    }

    pub fn tells(&self, what: What) -> bool {
        self.events.iter().any(|event| event.what == what)
    }
}

/// Where a field starts in a record.
fn word_of(name: &str) -> usize {
    let before = FIELDS.iter().take_while(|field| field.name != name);
    before.map(|field| field.words).sum()
}

fn all(ring: &RingReader<'_>) -> Vec<Vec<u64>> {
    let mut words = Vec::new();
    ring.read_since(0, usize::MAX, &mut words);
    let records = words.chunks(ring.record_words());
    records.map(<[u64]>::to_vec).collect()
}
