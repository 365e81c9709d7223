//! The tick allocates nothing: with any allocation in it this program aborts.

use assert_no_alloc::{assert_no_alloc, AllocDisabler};
use hapticd_control::controller::{Controller, Event, TickInput};
use hapticd_control::io::{status, Exchange, Observation};
use hapticd_control::model::DeviceModel;
use hapticd_control::record::TickRecord;
use hapticd_control::scene::{Mapping, Scene, Shape, Wall, MAX_WALLS};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

fn model(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

/// Sixteen walls through the home pose, each seen from another side.
fn scene(dof: usize, mapping: Mapping) -> Scene {
    let mut scene = Scene {
        count: 16,
        fade_s: 0.05,
        mapping,
        ..Scene::default()
    };
    for (i, wall) in scene.walls[..16].iter_mut().enumerate() {
        let angle = i as f64 * core::f64::consts::TAU / 16.0;
        let out_of_plane = if dof == 3 { 0.6 } else { 0.0 };
        let in_plane = f64::sqrt(1.0 - out_of_plane * out_of_plane);
        let normal = [in_plane * angle.cos(), in_plane * angle.sin(), out_of_plane];
        let offset_m = 0.21 * in_plane * angle.sin();
        *wall = Wall::plane(i as u64, normal, offset_m, i as f64 / 20.0);
    }
    scene
}

/// As many walls as a scene holds, of every shape, the nearest around the home pose.
fn crowd(dof: usize) -> Scene {
    let mut scene = scene(dof, Mapping::Transpose);
    scene.count = MAX_WALLS;
    for (i, wall) in scene.walls.iter_mut().enumerate().skip(8) {
        let hollow = i % 2 == 0;
        let center_m = [0.02 * (i % 16) as f64 - 0.15, 0.02 * (i / 16) as f64, 0.0];
        let shape = match i % 3 {
            0 => Shape::Sphere {
                center_m,
                radius_m: 0.03,
                hollow,
            },
            1 => Shape::Box {
                center_m,
                axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                half_m: [0.02, 0.02, 1.0],
                hollow,
            },
            _ => Shape::Capsule {
                from_m: center_m,
                to_m: [0.0, 0.2, 0.0],
                radius_m: 0.02,
                hollow,
            },
        };
        *wall = Wall {
            shape,
            ..Wall::plane(i as u64, [0.0, 0.0, 1.0], 0.0, 0.3)
        };
    }
    scene
}

/// Everything that can happen in a tick: ramp, contact, edits, missing frames, faults, recovery.
fn drive(model: &DeviceModel) -> u64 {
    let mut controller = Controller::new(model, 1000.0).expect("model is sound");
    let mut observation = Observation {
        status: status::HOMED | status::FORCE_PRESENT | status::OUTPUTS_LIVE,
        ..Observation::default()
    };
    for i in 0..model.dof {
        let angle = model.joints.home_rad[i] - model.joints.zero_rad[i];
        observation.counts[i] = (angle * model.joints.counts_per_rad[i]) as i64;
    }
    let scenes = [
        scene(model.dof, Mapping::Transpose),
        scene(model.dof, Mapping::Inverse),
        crowd(model.dof),
    ];
    let mut record = TickRecord::default();
    let mut contacts = 0;
    for tick in 0..2000_u64 {
        observation.counts[(tick % 2) as usize] += if tick % 500 < 250 { 2 } else { -2 };
        observation.force_n = [0.0, -5.0, 0.0];
        observation.seq += 1;
        observation.t_device_ns += 1_000_000;
        assert_no_alloc(|| {
            if tick % 300 == 10 {
                controller.adopt(&scenes[(tick / 300 % 3) as usize]);
            }
            if tick % 700 == 20 {
                let _ = controller.event(Event::Enable);
            }
            let missing = tick % 97 == 0;
            let input = TickInput {
                tick,
                t_mono_ns: tick * 1_000_000,
                exchange: if missing {
                    Exchange::Missing
                } else {
                    Exchange::Fresh
                },
                observation: &observation,
                front_alive: tick < 1800,
                late: tick % 3 == 0,
                realtime_ok: true,
            };
            let _ = controller.tick(&input, &mut record);
        });
        contacts += record.contact_count;
    }
    contacts
}

#[test]
fn tick_allocates_nothing() {
    let spatial = drive(&model(include_str!("../../../devices/phantom-1.0.toml")));
    let planar = drive(&model(include_str!("../../../devices/hhd.toml")));
    assert!(
        spatial > 1000 && planar > 1000,
        "the walls were not touched"
    );
}
