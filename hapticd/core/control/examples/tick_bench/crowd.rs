//! Walls around home, on a device of any reach.
//!
//! On a two-joint device cubes stand in a row, and reach far across its plane.

use hapticd_control::io::AXES;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::{Law, Scene, Shape, Wall, MAX_WALLS};

/// Half of a cube's edge, m.
const HALF_M: f64 = 0.01;
/// From one cube to the next, m.
const PITCH_M: f64 = 0.03;

/// Unit vectors of a workload: two across, the third out of the walls.
#[derive(Clone, Copy)]
pub struct Frame {
    home: V3,
    across: [V3; 2],
    up: V3,
    flat: bool,
}

impl Frame {
    pub fn of(model: &DeviceModel) -> Self {
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

/// Every shape in turn, hollow and solid, all with a surface through home.
fn close(frame: &Frame, i: usize, _: usize) -> Shape {
    let angle = 2.4 * i as f64;
    let normal = angle.cos() * frame.across[0] + angle.sin() * frame.up;
    let hollow = i % 2 == 0;
    let away = if hollow { HALF_M } else { -HALF_M };
    let center = frame.home + away * normal;
    match i % 8 {
        0 | 1 => Shape::Sphere {
            center_m: center.into(),
            radius_m: HALF_M,
            hollow,
        },
        2 | 3 => Shape::Capsule {
            from_m: center.into(),
            to_m: (center + away * normal).into(),
            radius_m: HALF_M,
            hollow,
        },
        4 | 5 => Shape::Plane {
            normal: normal.into(),
            offset_m: frame.home.dot(&normal),
        },
        _ => cube(
            frame,
            away * normal.dot(&frame.across[0]),
            0.0,
            away * normal.dot(&frame.up),
        ),
    }
}

pub type Workload = fn(&Frame, usize, usize) -> Shape;

/// Name, number of walls and shapes.
pub const WORKLOADS: [(&str, usize, Workload); 8] = [
    ("none", 0, boxes),
    ("planes", 16, planes),
    ("boxes", 1, boxes),
    ("boxes", 16, boxes),
    ("boxes", 64, boxes),
    ("boxes", MAX_WALLS, boxes),
    ("mixed", MAX_WALLS, mixed),
    ("close", MAX_WALLS, close),
];

pub fn scene(frame: &Frame, count: usize, workload: Workload) -> Scene {
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
pub fn tip(frame: &Frame, count: usize, tick: u64) -> V3 {
    let reach_m = if count <= 16 { 0.03 } else { 0.05 };
    let t = tick as f64 * 1e-3;
    let wave = |hertz: f64, phase: f64| (core::f64::consts::TAU * hertz * t + phase).sin();
    let (a, b) = (reach_m * wave(0.37, 0.0), reach_m * wave(0.23, 0.5));
    frame.at(a, b, 0.002 * wave(1.1, 0.0))
}
