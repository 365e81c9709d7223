//! Time of one control tick among walls: `cargo run --release --example tick_bench`, with a part
//! of a row's name behind it for some of the rows alone.

mod chai3d;
mod crowd;
mod driven;
mod timing;

use driven::Driven;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use timing::{preamble, report, timed, Tick};

fn model(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

/// The workloads of a device of its own reach.
fn crowds(model: &DeviceModel) {
    for (name, count, workload) in crowd::WORKLOADS {
        let name = format!("{} {count} {name}", model.name);
        let frame = crowd::Frame::of(model);
        report(&name, || {
            let mut driven = Driven::new(model, &crowd::scene(&frame, count, workload));
            move |tick| driven.tick(tick, &crowd::tip(&frame, count, tick))
        });
    }
}

/// The workload of the CHAI3D benchmark: the force of the walls alone, and the whole tick where
/// the device reaches it.
fn like_chai3d(model: &DeviceModel) {
    for (count, reach_m) in chai3d::SIZES {
        for (motion, height) in chai3d::MOTIONS {
            let name = format!("CHAI3D {count} {motion}");
            report(&format!("{name}: force"), || {
                let mut force = Box::new(chai3d::Force::of(&chai3d::scene(count, &V3::zeros())));
                move |tick| {
                    let x = chai3d::tip(reach_m, height, tick);
                    let (force_n, time_ns) = timed(|| force.at(&x));
                    let touching = force_n.norm() > 0.0;
                    Tick { time_ns, touching }
                }
            });
            let Some(middle) = middle(model, reach_m) else {
                println!("{name}: out of reach of {}", model.name);
                continue;
            };
            report(&format!("{name}: tick of {}", model.name), || {
                let mut driven = Driven::new(model, &chai3d::scene(count, &middle));
                move |tick| driven.tick(tick, &(middle + chai3d::tip(reach_m, height, tick)))
            });
        }
    }
}

/// Highest place of the tip over the walls, m.
const TOP_M: f64 = 0.04;

/// Where a device can roam so far to all sides, m.
fn middle(model: &DeviceModel, reach_m: f64) -> Option<V3> {
    let grid = (0..30).flat_map(|x| (0..30).map(move |z| (x, z)));
    let places = grid.map(|(x, z)| V3::new(0.01 * f64::from(x), 0.0, 0.01 * f64::from(z) - 0.15));
    let reaches = |x: V3| {
        let q = model.kinematics.inverse(&x);
        q.is_some_and(|q| model.kinematics.inside(&model.joints, &q, 0.0))
    };
    let corners = |middle: &V3| {
        let sides = [-reach_m, 0.0, reach_m];
        let heights = [-0.002, TOP_M];
        let all = sides.map(|x| sides.map(|y| heights.map(|z| middle + V3::new(x, y, z))));
        all.into_iter().flatten().flatten().all(reaches)
    };
    places.into_iter().find(corners)
}

fn main() {
    println!("{}", preamble());
    let phantom = model(include_str!("../../../../devices/phantom-1.0.toml"));
    let hhd = model(include_str!("../../../../devices/hhd.toml"));
    crowds(&phantom);
    crowds(&hhd);
    like_chai3d(&phantom);
}
