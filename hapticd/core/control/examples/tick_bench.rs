//! Time of one control tick among walls: `cargo run --release --example tick_bench`.
//!
//! The boxes and the motion are those of the CHAI3D benchmark: cubes of 20 mm in a grid of 30 mm
//! with their tops at one height, and a tip that roams over them while it dips 2 mm in and out.
//! On a two-joint device the cubes stand in a row, and reach far across its plane.

use hapticd_control::controller::{Controller, Event, TickInput};
use hapticd_control::io::{status, Exchange, Observation, AXES};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::TickRecord;
use hapticd_control::scene::{Law, Scene, Shape, Wall, MAX_WALLS};
use std::time::Instant;

const TICKS: u64 = 200_000;
/// Ticks before the first one timed.
const WARM_UP: usize = 20_000;
/// Half of a cube's edge, m.
const HALF_M: f64 = 0.01;
/// From one cube to the next, m.
const PITCH_M: f64 = 0.03;

fn model(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

/// Unit vectors of a workload: two across, the third out of the walls.
struct Frame {
    home: V3,
    across: [V3; 2],
    up: V3,
    flat: bool,
}

impl Frame {
    fn of(model: &DeviceModel) -> Self {
        let flat = model.dof == 2;
        let home = model.kinematics.forward(&model.joints.home_rad.into());
        let (across, up) = if flat {
            ([V3::x(), V3::zeros()], V3::y())
        } else {
            ([V3::x(), V3::y()], V3::z())
        };
        Self {
            home,
            across,
            up,
            flat,
        }
    }

    fn at(&self, a: f64, b: f64, height: f64) -> V3 {
        self.home + a * self.across[0] + b * self.across[1] + height * self.up
    }
}

fn wall(key: usize, shape: Shape) -> Wall {
    Wall {
        shape,
        law: Law::Motion { eta: 0.5 },
        ..Wall::plane(key as u64 + 1, [0.0, 0.0, 1.0], 0.0, 0.5)
    }
}

fn cube(frame: &Frame, a: f64, b: f64, height: f64) -> Shape {
    let mut center = frame.at(a, b, height);
    let mut half_m = [HALF_M; AXES];
    if frame.flat {
        center.z = 0.0;
        half_m[2] = 10.0;
    }
    Shape::Box {
        center_m: center.into(),
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        half_m,
        hollow: false,
    }
}

fn place(frame: &Frame, i: usize, count: usize) -> (f64, f64) {
    let side = if frame.flat {
        count
    } else {
        (count as f64).sqrt().ceil() as usize
    };
    let offset = |n: usize| (n as f64 - 0.5 * (side as f64 - 1.0)) * PITCH_M;
    let row = if frame.flat { 0.0 } else { offset(i / side) };
    (offset(i % side), row)
}

/// Cubes in a grid, their tops at the height of home.
fn boxes(frame: &Frame, i: usize, count: usize) -> Shape {
    let (a, b) = place(frame, i, count);
    cube(frame, a, b, -HALF_M)
}

/// Planes all around home, 0 to 1.5 mm behind it.
fn planes(frame: &Frame, i: usize, count: usize) -> Shape {
    let angle = i as f64 * core::f64::consts::TAU / count as f64;
    let normal = angle.cos() * frame.across[0] + angle.sin() * frame.up;
    Shape::Plane {
        normal: normal.into(),
        offset_m: frame.home.dot(&normal) - 0.0005 * (i % 4) as f64,
    }
}

/// Every shape in turn, hollow and solid, in the grid of the cubes.
fn mixed(frame: &Frame, i: usize, count: usize) -> Shape {
    let (a, b) = place(frame, i, count);
    let center = frame.at(a, b, -HALF_M);
    let hollow = i % 2 == 0;
    match i % 8 {
        0 | 1 => Shape::Sphere {
            center_m: center.into(),
            radius_m: HALF_M,
            hollow,
        },
        2 | 3 => Shape::Capsule {
            from_m: center.into(),
            to_m: (center + 0.5 * HALF_M * frame.across[0]).into(),
            radius_m: HALF_M,
            hollow,
        },
        7 => Shape::Plane {
            normal: frame.up.into(),
            offset_m: frame.home.dot(&frame.up) - 0.02 - 0.001 * i as f64,
        },
        _ => cube(frame, a, b, -HALF_M),
    }
}

type Workload = fn(&Frame, usize, usize) -> Shape;

fn scene(frame: &Frame, count: usize, workload: Workload) -> Scene {
    let mut scene = Scene {
        count,
        ..Scene::default()
    };
    for (i, slot) in scene.walls[..count].iter_mut().enumerate() {
        *slot = wall(i, workload(frame, i, count));
    }
    scene
}

/// The tip at tick `tick`, m.
fn tip(frame: &Frame, reach_m: f64, tick: u64) -> V3 {
    let t = tick as f64 * 1e-3;
    let wave = |hertz: f64, phase: f64| (core::f64::consts::TAU * hertz * t + phase).sin();
    let (a, b) = (reach_m * wave(0.37, 0.0), reach_m * wave(0.23, 0.5));
    frame.at(a, b, 0.002 * wave(1.1, 0.0))
}

/// Counts of the joints at `x`, m.
fn counts(model: &DeviceModel, x: &V3) -> [i64; AXES] {
    let q = model.kinematics.inverse(x).expect("the tip is in reach");
    core::array::from_fn(|i| {
        ((q[i] - model.joints.zero_rad[i]) * model.joints.counts_per_rad[i]) as i64
    })
}

fn tick_times_ns(model: &DeviceModel, count: usize, workload: Workload) -> (Vec<u64>, u64) {
    let frame = Frame::of(model);
    let reach_m = if count <= 16 { 0.03 } else { 0.05 };
    let mut controller = Box::new(Controller::new(model, 1000.0).expect("model is sound"));
    controller.adopt(&scene(&frame, count, workload));
    let mut observation = Observation {
        status: status::HOMED | status::FORCE_PRESENT | status::OUTPUTS_LIVE,
        ..Observation::default()
    };
    let mut record = TickRecord::default();
    let mut times_ns = Vec::with_capacity(TICKS as usize);
    let mut touching = 0;
    for tick in 0..TICKS {
        observation.seq += 1;
        observation.t_device_ns += 1_000_000;
        observation.counts = counts(model, &tip(&frame, reach_m, tick));
        let input = TickInput {
            tick,
            t_mono_ns: tick * 1_000_000,
            exchange: Exchange::Fresh,
            observation: &observation,
            front_alive: true,
            late: false,
            realtime_ok: true,
        };
        if tick == 1 {
            controller
                .event(Event::Enable)
                .expect("nothing is in the way");
        }
        let start = Instant::now();
        std::hint::black_box(controller.tick(&input, &mut record));
        times_ns.push(start.elapsed().as_nanos() as u64);
        touching += u64::from(record.contact_count > 0);
    }
    assert_eq!(record.faults, 0, "the run ended in a fault");
    (times_ns, touching)
}

/// Median cost of reading the clock, which every figure includes, ns.
fn clock_ns() -> u64 {
    let mut times_ns: Vec<u64> = (0..10_000)
        .map(|_| Instant::now().elapsed().as_nanos() as u64)
        .collect();
    times_ns.sort_unstable();
    times_ns[times_ns.len() / 2]
}

fn report(model: &DeviceModel, name: &str, count: usize, workload: Workload) {
    let (times_ns, touching) = tick_times_ns(model, count, workload);
    let mut times_ns = times_ns[WARM_UP..].to_vec();
    times_ns.sort_unstable();
    let at = |share: f64| times_ns[((times_ns.len() - 1) as f64 * share) as usize];
    println!(
        "{:<12} {count:>3} {name:<7} median {:>5} ns   p99 {:>6} ns   p99.9 {:>6} ns   touching {:>3} %",
        model.name,
        at(0.5),
        at(0.99),
        at(0.999),
        100 * touching / TICKS
    );
}

fn main() {
    println!(
        "control tick, {TICKS} ticks each; reading the clock is {} ns of it",
        clock_ns()
    );
    for text in [
        include_str!("../../../devices/phantom-1.0.toml"),
        include_str!("../../../devices/hhd.toml"),
    ] {
        let model = model(text);
        report(&model, "none", 0, boxes);
        report(&model, "planes", 16, planes);
        for count in [1, 16, 64, MAX_WALLS] {
            report(&model, "boxes", count, boxes);
        }
        report(&model, "mixed", MAX_WALLS, mixed);
    }
}
