//! A controller with a device of straw: joints go where the test says, the board obeys.

use hapticd_control::controller::{Controller, Event, State, TickInput};
use hapticd_control::fault::{Fault, FaultSet};
use hapticd_control::io::{status, Command, Exchange, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::TickRecord;
use hapticd_control::scene::{Scene, Wall};

pub const RATE_HZ: f64 = 1000.0;
const PERIOD_NS: u64 = 1_000_000;

pub struct Rig {
    pub model: DeviceModel,
    pub controller: Controller,
    pub observation: Observation,
    pub record: TickRecord,
    pub command: Command,
    pub front_alive: bool,
    pub late: bool,
    pub realtime_ok: bool,
    /// Whether the board drives what it is asked to.
    pub obeys: bool,
    pub tick: u64,
}

impl Rig {
    pub fn new(model: DeviceModel) -> Self {
        let mut observation = Observation {
            status: status::HOMED,
            ..Observation::default()
        };
        if model.limits.sensor_force_n > 0.0 {
            observation.status |= status::FORCE_PRESENT;
        }
        let mut rig = Self {
            controller: Controller::new(&model, RATE_HZ).expect("model is sound"),
            observation,
            record: TickRecord::default(),
            command: Command::default(),
            front_alive: true,
            late: false,
            realtime_ok: true,
            obeys: true,
            tick: 0,
            model,
        };
        rig.place(&rig.home());
        rig
    }

    pub fn home(&self) -> V3 {
        self.model.joints.home_rad.into()
    }

    /// Puts the joints at `q`, rad, to the nearest count.
    pub fn place(&mut self, q: &V3) {
        let joints = &self.model.joints;
        for i in 0..self.model.dof {
            let counts = (q[i] - joints.zero_rad[i]) * joints.counts_per_rad[i];
            self.observation.counts[i] = counts.round() as i64;
        }
    }

    pub fn hand(&mut self, force_n: V3) {
        self.observation.force_n = force_n.into();
    }

    /// One tick with a new frame.
    pub fn step(&mut self) -> Command {
        self.observation.seq += 1;
        self.observation.t_device_ns += PERIOD_NS;
        let live = if self.obeys && self.command.enable {
            status::OUTPUTS_LIVE
        } else {
            0
        };
        self.observation.status = self.observation.status & !status::OUTPUTS_LIVE | live;
        self.exchange(Exchange::Fresh)
    }

    /// One tick with the observation as it is.
    pub fn exchange(&mut self, exchange: Exchange) -> Command {
        self.tick += 1;
        let input = TickInput {
            tick: self.tick,
            t_mono_ns: self.tick * PERIOD_NS,
            exchange,
            observation: &self.observation,
            front_alive: self.front_alive,
            late: self.late,
            realtime_ok: self.realtime_ok,
        };
        self.command = self.controller.tick(&input, &mut self.record);
        self.command
    }

    pub fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.step();
        }
    }

    pub fn enable(&mut self) {
        self.step();
        self.controller
            .event(Event::Enable)
            .expect("no interlock is open");
    }

    /// Enabled, ramped up, at home, in free space.
    pub fn running(model: DeviceModel) -> Self {
        let mut rig = Self::new(model);
        rig.enable();
        let ramp_ticks = (rig.model.limits.ramp_s * RATE_HZ) as usize;
        rig.steps(ramp_ticks + 10);
        assert_eq!(rig.record.gain, 1.0);
        rig
    }

    /// Running, pressed `depth_m` into a rigid wall that faces the base.
    pub fn pressing(model: DeviceModel, depth_m: f64) -> Self {
        let mut rig = Self::running(model);
        rig.wall_at(depth_m, 0.0);
        rig.steps(100);
        rig
    }

    /// A wall around the tip, whose normal points to the base.
    pub fn wall_at(&mut self, depth_m: f64, fade_s: f64) {
        let tip = V3::from(self.record.tip_position_m);
        let normal = -tip.normalize();
        let wall = Wall::plane(1, normal.into(), normal.dot(&tip) + depth_m, 0.0);
        self.controller.adopt(&scene(&[wall], fade_s));
    }

    pub fn state(&self) -> State {
        self.controller.state()
    }

    pub fn has(&self, fault: Fault) -> bool {
        FaultSet::from_bits(self.record.faults).contains(fault)
    }

    pub fn acknowledge_all(&mut self) {
        let all = FaultSet::from_bits(u64::MAX);
        self.controller
            .event(Event::FaultAcknowledge(all))
            .expect("a fault can always be acknowledged");
    }
}

pub fn scene(walls: &[Wall], fade_s: f64) -> Scene {
    let mut scene = Scene {
        revision: 1,
        fade_s,
        count: walls.len(),
        ..Scene::default()
    };
    scene.walls[..walls.len()].copy_from_slice(walls);
    scene
}

/// Whether a command asks nothing of any actuator.
pub fn is_zero(command: &Command) -> bool {
    *command == Command::default()
}

/// Tip force that was commanded, N.
pub fn tip_force_n(record: &TickRecord) -> V3 {
    record.tip_force_command_n.into()
}

/// Has an event carried out.
pub fn ask(rig: &mut Rig, event: Event) {
    rig.controller.event(event).expect("event is carried out");
}

/// Runs to the end of a fade and gives the largest step of the commanded force on the way, N.
pub fn fade_out(rig: &mut Rig) -> f64 {
    let mut largest_n: f64 = 0.0;
    let ticks = (2.0 * rig.model.limits.fade_s * RATE_HZ) as usize + 2;
    for _ in 0..ticks {
        let before = tip_force_n(&rig.record);
        rig.step();
        largest_n = largest_n.max((tip_force_n(&rig.record) - before).norm());
    }
    largest_n
}
