//! Time of one control tick with 16 walls: `cargo run --release --example tick_bench`.

use hapticd_control::controller::{Controller, Event, TickInput};
use hapticd_control::io::{status, Exchange, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::TickRecord;
use hapticd_control::scene::{Scene, Wall};
use std::time::Instant;

const TICKS: u64 = 200_000;
const WALLS: usize = 16;

fn model(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

/// A cage of walls of different η, some of which hold the home pose.
fn cage(model: &DeviceModel) -> Scene {
    let home = model.kinematics.forward(&model.joints.home_rad.into());
    let mut scene = Scene {
        count: WALLS,
        ..Scene::default()
    };
    for (i, wall) in scene.walls[..WALLS].iter_mut().enumerate() {
        let angle = i as f64 * core::f64::consts::TAU / WALLS as f64;
        let normal = V3::new(angle.cos(), angle.sin(), 0.0);
        let depth_m = 0.001 - 0.0005 * (i % 4) as f64;
        let eta = 0.05 * (i % 8) as f64;
        *wall = Wall::plane(i as u64, normal.into(), home.dot(&normal) + depth_m, eta);
    }
    scene
}

fn place(model: &DeviceModel, observation: &mut Observation) {
    for i in 0..model.dof {
        let angle = model.joints.home_rad[i] - model.joints.zero_rad[i];
        observation.counts[i] = (angle * model.joints.counts_per_rad[i]) as i64;
    }
}

fn tick_times_ns(model: &DeviceModel) -> Vec<u64> {
    let mut controller = Controller::new(model, 1000.0).expect("model is sound");
    let mut observation = Observation {
        status: status::HOMED | status::FORCE_PRESENT | status::OUTPUTS_LIVE,
        ..Observation::default()
    };
    place(model, &mut observation);
    controller.adopt(&cage(model));
    let mut record = TickRecord::default();
    let mut times_ns = Vec::with_capacity(TICKS as usize);
    for tick in 0..TICKS {
        observation.seq += 1;
        observation.t_device_ns += 1_000_000;
        observation.counts[0] += if tick % 40 < 20 { 1 } else { -1 };
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
    }
    assert_eq!(record.faults, 0, "the run ended in a fault");
    assert!(record.contact_count > 0, "no wall was touched");
    times_ns
}

/// Median cost of reading the clock, which every figure includes, ns.
fn clock_ns() -> u64 {
    let mut times_ns: Vec<u64> = (0..10_000)
        .map(|_| Instant::now().elapsed().as_nanos() as u64)
        .collect();
    times_ns.sort_unstable();
    times_ns[times_ns.len() / 2]
}

fn main() {
    println!(
        "reading the clock: {} ns, part of every tick below",
        clock_ns()
    );
    for text in [
        include_str!("../../../devices/phantom-1.0.toml"),
        include_str!("../../../devices/hhd.toml"),
    ] {
        let model = model(text);
        let mut times_ns = tick_times_ns(&model);
        times_ns.sort_unstable();
        let at = |share: f64| times_ns[((times_ns.len() - 1) as f64 * share) as usize];
        println!(
            "control tick, {} walls, {:<12} median {:>5} ns   p99 {:>5} ns   p99.9 {:>6} ns   ({TICKS} ticks)",
            WALLS, model.name, at(0.5), at(0.99), at(0.999)
        );
    }
}
