//! The workload of the CHAI3D benchmark: springs of 1000 N/m, a tip that roams over them.
//!
//! One box of 200 × 200 × 20 mm, or cubes of 20 mm in a square grid of 30 mm, their tops at one
//! height. The tip goes up and down over them, in and out of them, or within them.

use hapticd_control::estimate::JointState;
use hapticd_control::law::Tip;
use hapticd_control::layers::Layers;
use hapticd_control::linear::V3;
use hapticd_control::render::blend::{reference_n_per_m, soften, Answers, Blend, Rigid, Scratch};
use hapticd_control::render::touch::Touches;
use hapticd_control::scene::{Law, Scene, Shape, Wall};
use std::f64::consts::TAU;

/// Stiffness of every wall, N/m.
const STIFFNESS_N_PER_M: f64 = 1000.0;
/// Half of a cube's edge, and of the box's height, m.
const HALF_M: f64 = 0.01;
/// From one cube to the next, m.
const PITCH_M: f64 = 0.03;
/// Half of the one box's other edges, m.
const HALF_WIDTH_M: f64 = 0.1;

/// Height of the tip over the walls at `t`, s, in m.
type Height = fn(f64) -> f64;

/// Name and height of every motion.
pub const MOTIONS: [(&str, Height); 3] = [
    ("free", |t| 0.03 + 0.01 * wave(1.1, 0.0, t)),
    ("mixed", |t| 0.002 * wave(1.1, 0.0, t)),
    ("press", |t| -0.001 + 0.0005 * wave(1.1, 0.0, t)),
];

/// Number of walls, and how far the tip roams over them, m.
pub const SIZES: [(usize, f64); 3] = [(1, 0.05), (16, 0.06), (64, 0.12)];

fn wave(hertz: f64, phase: f64, t: f64) -> f64 {
    (TAU * hertz * t + phase).sin()
}

/// The tip in tick `tick`, of 100 000 that repeat, from the middle of the walls' tops, m.
pub fn tip(reach_m: f64, height: Height, tick: u64) -> V3 {
    let t = (tick % 100_000) as f64 * 1e-3;
    V3::new(
        reach_m * wave(0.37, 0.0, t),
        reach_m * wave(0.23, 0.5, t),
        height(t),
    )
}

/// `count` walls with the middle of their tops at `middle`, m.
pub fn scene(count: usize, middle: &V3) -> Scene {
    let mut scene = Scene {
        count,
        ..Scene::default()
    };
    let side = (count as f64).sqrt() as usize;
    let offset_m = |n: usize| (n as f64 - 0.5 * (side as f64 - 1.0)) * PITCH_M;
    let wide_m = if count == 1 { HALF_WIDTH_M } else { HALF_M };
    for (i, wall) in scene.walls[..count].iter_mut().enumerate() {
        let center = middle + V3::new(offset_m(i % side), offset_m(i / side), -HALF_M);
        *wall = Wall {
            shape: Shape::Box {
                center_m: center.into(),
                axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                half_m: [wide_m, wide_m, HALF_M],
                hollow: false,
            },
            law: Law::Spring {
                stiffness_n_per_m: STIFFNESS_N_PER_M,
                damping_n_s_per_m: 0.0,
            },
            ..Wall::plane(i as u64 + 1, [0.0, 0.0, 1.0], 0.0, 0.0)
        };
    }
    scene
}

/// The force of the walls alone: proxy and laws, without device or limits.
pub struct Force {
    layers: Layers,
    tip: Tip,
    touches: Touches,
    scratch: Scratch,
}

impl Force {
    pub fn of(scene: &Scene) -> Self {
        let mut layers = Layers::new();
        layers.adopt(scene);
        Self {
            layers,
            tip: Tip {
                damping_max_n_s_per_m: 10.0,
                force_max_n: 10.0,
            },
            touches: Touches::default(),
            scratch: Scratch::default(),
        }
    }

    /// Force on a tip at `x`, m, in N.
    pub fn at(&mut self, x: &V3) -> V3 {
        let rigid = Rigid {
            stiffness_n_per_m: 2.0 * STIFFNESS_N_PER_M,
            damping_n_s_per_m: 0.0,
        };
        let k_c = rigid.stiffness_n_per_m;
        self.layers.follow(x, |scene, facings| {
            soften(scene, facings, k_c, reference_n_per_m(scene, k_c));
        });
        let state = JointState {
            x: *x,
            ..JointState::default()
        };
        let mut blend = Blend::default();
        self.touches.clear();
        for layer in self.layers.weighted() {
            let answers = Answers {
                state: &state,
                tip: &self.tip,
                rigid,
                reference_n_per_m: reference_n_per_m(layer.1, k_c),
            };
            answers.add(layer, &mut blend, &mut self.touches, &mut self.scratch);
        }
        blend.spring_n
    }
}
