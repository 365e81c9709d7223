//! Scenes of any walls on both drives.

use crate::models::{hhd, phantom, torque_drive};
use crate::rig::scene;
use hapticd_control::estimate::JointState;
use hapticd_control::law::spring::damper_share;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::render::touch::Touch;
use hapticd_control::render::{Renderer, Rendering};
use hapticd_control::scene::{CubicForm, Law, Shape, Wall};
use proptest::prelude::*;

const DR_OHM: V3 = V3::new(0.109, 0.109, 0.109);

fn any_law() -> impl Strategy<Value = Law> {
    prop_oneof![
        (0.0..=1.0_f64).prop_map(|eta| Law::Motion { eta }),
        (0.0..200_000.0_f64, 0.0..500.0_f64).prop_map(|(k, b)| Law::Spring {
            stiffness_n_per_m: k,
            damping_n_s_per_m: b,
        }),
        (0.0..500.0_f64).prop_map(|damping_n_s_per_m| Law::Damper { damping_n_s_per_m }),
        any::<bool>().prop_map(|implicit| Law::CubicDamper {
            coefficient_n_s3_per_m3: 1.6e6,
            form: if implicit {
                CubicForm::Implicit
            } else {
                CubicForm::Explicit
            },
        }),
    ]
}

/// One of the devices at rest in its home pose.
fn at_home(model: &DeviceModel) -> JointState {
    JointState::at(&model.kinematics, model.joints.home_rad.into(), V3::zeros())
}

/// Plane walls around the tip of `state`, up to 5 mm from it.
fn walls_around(state: &JointState, parts: &[(f64, f64, Law, bool)]) -> Vec<Wall> {
    let wall = |(i, (azimuth, depth_m, law, brake)): (usize, &(f64, f64, Law, bool))| {
        let normal = V3::new(azimuth.cos(), azimuth.sin(), 0.0);
        Wall {
            law: *law,
            brake: *brake,
            ..Wall::plane(i as u64, normal.into(), normal.dot(&state.x) + depth_m, 0.0)
        }
    };
    parts.iter().enumerate().map(wall).collect()
}

fn normal_of(wall: &Wall) -> V3 {
    match wall.shape {
        Shape::Plane { normal, .. } => normal.into(),
        Shape::Sphere { .. } | Shape::Box { .. } | Shape::Capsule { .. } => V3::zeros(),
    }
}

fn any_walls() -> impl Strategy<Value = Vec<(f64, f64, Law, bool)>> {
    let part = (
        0.0..core::f64::consts::TAU,
        -0.005..0.005_f64,
        any_law(),
        any::<bool>(),
    );
    prop::collection::vec(part, 1..6)
}

/// `state` moved by `dx`, with the tip moving at `xd`.
fn moved(model: &DeviceModel, state: &JointState, dx: V3, xd: V3) -> JointState {
    let q = state.q + state.jacobian_inverse * dx;
    let there = JointState::at(&model.kinematics, q, V3::zeros());
    JointState::at(&model.kinematics, q, there.jacobian_inverse * xd)
}

struct Bench {
    renderer: Renderer,
}

impl Bench {
    fn new(model: &DeviceModel, walls: &[Wall]) -> Self {
        let mut renderer = Renderer::new(model, 1e-3);
        renderer.adopt(&scene(walls, 0.0));
        Self { renderer }
    }

    fn at(&mut self, state: &JointState) -> Rendering {
        self.renderer.render(state, &DR_OHM, None)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(96) })]

    #[test]
    fn walls_push_and_never_pull(parts in any_walls(), xd in prop::array::uniform2(-1.0..1.0_f64), flat in any::<bool>()) {
        let model = if flat { hhd() } else { phantom() };
        let home = at_home(&model);
        let state = moved(&model, &home, V3::zeros(), V3::new(xd[0], xd[1], 0.0));
        let mut bench = Bench::new(&model, &walls_around(&state, &parts));
        let _ = bench.at(&state);
        for touch in bench.renderer.touches() {
            prop_assert!(touch.push.force_n >= 0.0);
            prop_assert!((touch.push.normal.norm() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn dampers_take_energy_in_every_scene(parts in any_walls(), xd in prop::array::uniform2(-1.0..1.0_f64)) {
        let model = hhd();
        let home = at_home(&model);
        let mut bench = Bench::new(&model, &walls_around(&home, &parts));
        let resting_n = bench.at(&home).demand.force_n;
        let state = moved(&model, &home, V3::zeros(), V3::new(xd[0], xd[1], 0.0));
        let damping_n = bench.at(&state).demand.force_n - resting_n;
        prop_assert!(damping_n.dot(&state.xd) <= 1e-9 * damping_n.norm().max(1.0));
    }

    #[test]
    fn doubled_wall_pushes_like_one(parts in any_walls(), xd in prop::array::uniform2(-1.0..1.0_f64)) {
        // The envelope of the stiffest wall with itself is that wall.
        let model = hhd();
        let home = at_home(&model);
        let state = moved(&model, &home, V3::zeros(), V3::new(xd[0], xd[1], 0.0));
        let hard = Law::Spring { stiffness_n_per_m: 1e5, damping_n_s_per_m: 300.0 };
        let single = walls_around(&home, &[(parts[0].0, 0.002, hard, true)]);
        let damper = walls_around(&home, &[(parts[0].0, 0.002, Law::Damper { damping_n_s_per_m: 300.0 }, true)]);
        for one in [single, damper] {
            let mut twice = vec![one[0], one[0]];
            twice[1].key = 9;
            let alone_n = Bench::new(&model, &one).at(&state).demand.force_n;
            let doubled_n = Bench::new(&model, &twice).at(&state).demand.force_n;
            prop_assert!((alone_n - doubled_n).norm() <= 1e-5 * alone_n.norm().max(1.0));
        }
    }

    #[test]
    fn overlapping_springs_are_never_stiffer_than_the_stiffest(
        parts in any_walls(), dx in prop::array::uniform2(-1e-4..1e-4_f64),
    ) {
        let model = hhd();
        let home = at_home(&model);
        let walls = walls_around(&home, &parts);
        let stiffest = walls.iter().map(|wall| match wall.law {
            Law::Spring { stiffness_n_per_m, .. } => stiffness_n_per_m,
            Law::Motion { eta } => (1.0 - eta) * torque_drive().stiffness_n_per_m,
            Law::Damper { .. } | Law::CubicDamper { .. } => 0.0,
        }).fold(torque_drive().stiffness_n_per_m, f64::max);
        let mut bench = Bench::new(&model, &walls);
        let there = moved(&model, &home, V3::new(dx[0], dx[1], 0.0), V3::zeros());
        let change_n = bench.at(&there).demand.force_n - bench.at(&home).demand.force_n;
        prop_assert!(change_n.norm() <= stiffest * (there.x - home.x).norm() * (1.0 + 1e-6) + 1e-6);
    }

    #[test]
    fn closed_loop_through_springs_gains_nothing(parts in any_walls(), radius_m in 0.5e-3..4e-3_f64) {
        // Corners of 65° and more.
        let corner = |part: &(f64, f64, Law, bool)| (part.0 / core::f64::consts::PI, part.1, part.2, part.3);
        let parts: Vec<_> = parts.iter().map(corner).collect();
        let model = hhd();
        let home = at_home(&model);
        let mut bench = Bench::new(&model, &walls_around(&home, &parts));
        let on_loop = |i: usize| {
            let angle = i as f64 / 400.0 * core::f64::consts::TAU;
            let dx = V3::new(angle.cos() - 1.0, angle.sin(), 0.0) * radius_m;
            let reached = moved(&model, &home, dx, V3::zeros());
            moved(&model, &reached, home.x + dx - reached.x, V3::zeros())
        };
        // The tip comes from free space, like a hand.
        let out: V3 = walls_around(&home, &parts).iter().map(normal_of).sum();
        let _ = bench.at(&moved(&model, &home, 0.04 * out.normalize(), V3::zeros()));
        let _ = bench.at(&on_loop(0));
        let (mut before, mut work_j, mut size_j) = (on_loop(0), 0.0, 0.0);
        let mut before_n = bench.at(&before).demand.force_n;
        for i in 1..=400 {
            let state = on_loop(i);
            let force_n = bench.at(&state).demand.force_n;
            let step_j = 0.5 * (force_n + before_n).dot(&(state.x - before.x));
            (before, before_n) = (state, force_n);
            work_j += step_j;
            size_j += step_j.abs();
        }
        // Each wall entered or left between two points costs one trapezium of the sum.
        prop_assert!(work_j.abs() <= 2e-3 * size_j + 1e-7, "{work_j} of {size_j}");
    }

    #[test]
    fn pushes_of_the_walls_sum_to_the_force(parts in any_walls(), xd in prop::array::uniform2(-0.3..0.3_f64)) {
        let model = hhd();
        let home = at_home(&model);
        let state = moved(&model, &home, V3::zeros(), V3::new(xd[0], xd[1], 0.0));
        let mut bench = Bench::new(&model, &walls_around(&home, &parts));
        let demand = bench.at(&state).demand;
        let touches = bench.renderer.touches();
        let springs_n: V3 = touches.iter().map(|touch| touch.parts.spring_n).sum();
        let dampers_n: V3 = touches.iter().map(|touch| touch.parts.damper_n).sum();
        let share = damper_share(&springs_n, &dampers_n);
        // A rigid wall's set-point lies within some 1e-9 m of its surface.
        let size_n = |touch: &Touch| touch.parts.spring_n.norm() + touch.parts.damper_n.norm();
        let scale = 2e-5 * touches.iter().map(size_n).sum::<f64>().max(1.0);
        let (mut all_n, mut own_n) = (V3::zeros(), V3::zeros());
        for Touch { push, parts, brake, .. } in touches {
            let force_n = parts.force_n(share);
            all_n += force_n;
            own_n += if *brake { V3::zeros() } else { force_n };
            let pushed_n = push.force_n * push.normal;
            let outwards = force_n.dot(&push.normal) <= scale;
            prop_assert!((pushed_n - force_n).norm() < scale || outwards && push.force_n == 0.0);
        }
        prop_assert!((all_n - demand.force_n).norm() < scale, "{all_n} for {}", demand.force_n);
        let own_nm = state.jacobian.tr_mul(&own_n);
        prop_assert!((own_nm - demand.motor_only_nm).norm() < scale);
    }
}

#[test]
fn spring_wall_gives_its_stiffness_on_the_torque_drive_also_above_the_couplings() {
    let model = hhd();
    let home = at_home(&model);
    for k in [20_000.0, 60_000.0, 150_000.0] {
        let law = Law::Spring {
            stiffness_n_per_m: k,
            damping_n_s_per_m: 0.0,
        };
        let walls = walls_around(&home, &[(0.5, 0.0005, law, true)]);
        let rendering = Bench::new(&model, &walls).at(&home);
        let force_n = rendering.demand.force_n.norm();
        assert!((force_n - 0.0005 * k).abs() < 1e-4 * force_n, "{force_n}");
        let pull_n = torque_drive().stiffness_n_per_m * (rendering.set_point.x_sd - home.x).norm();
        assert!((pull_n - force_n).abs() < 1e-6 * force_n);
        assert!((rendering.touched_force_n.x - force_n).abs() < 1e-6 * force_n);
    }
}

#[test]
fn spring_wall_on_the_spring_drive_gets_what_there_is() {
    let model = phantom();
    let home = at_home(&model);
    let force_n = |k: f64| {
        let law = Law::Spring {
            stiffness_n_per_m: k,
            damping_n_s_per_m: 0.0,
        };
        let walls = walls_around(&home, &[(0.5, 0.001, law, true)]);
        let rendering = Bench::new(&model, &walls).at(&home);
        (rendering.demand.force_n.norm(), rendering.stiffness_n_per_m)
    };
    let (soft_n, k_c) = force_n(500.0);
    assert!((soft_n - 0.5).abs() < 1e-6, "{soft_n}");
    assert!(
        (force_n(1e6).0 - 0.001 * k_c).abs() < 1e-3,
        "granted at most k_c"
    );
}

#[test]
fn damper_wall_is_touched_and_gives_nothing_at_rest_or_outwards() {
    for model in [hhd(), phantom()] {
        let home = at_home(&model);
        let law = Law::Damper {
            damping_n_s_per_m: 20.0,
        };
        let walls = walls_around(&home, &[(0.0, 0.001, law, false)]);
        let mut bench = Bench::new(&model, &walls);
        let mut at = |speed: f64| bench.at(&moved(&model, &home, V3::zeros(), V3::x() * speed));
        assert_eq!(at(0.0).contact.count, 1);
        assert!(at(0.0).demand.force_n.norm() < 1e-6);
        let inward_n = at(-0.1).demand.force_n;
        assert!((inward_n - V3::x() * 2.0).norm() < 1e-4, "{inward_n}");
        assert!(at(0.1).demand.force_n.norm() < 1e-6);
    }
}

/// A tip that starts among walls, without a history: nothing tells where it came from.
fn started_among(parts: &[(f64, f64)]) -> f64 {
    let model = hhd();
    let home = at_home(&model);
    let rigid = |&(angle, depth_m): &(f64, f64)| (angle, depth_m, Law::Motion { eta: 0.0 }, false);
    let parts: Vec<_> = parts.iter().map(rigid).collect();
    let mut bench = Bench::new(&model, &walls_around(&home, &parts));
    let aside = moved(&model, &home, V3::new(-6e-5, 0.0, 0.0), V3::zeros());
    let change_n = bench.at(&aside).demand.force_n - bench.at(&home).demand.force_n;
    change_n.norm() / (aside.x - home.x).norm()
}

#[test]
fn tip_that_starts_in_a_sharp_wedge_finds_its_corner_at_once() {
    let wedge = [(0.0, 3.67e-3), (155_f64.to_radians(), 0.05e-3)];
    assert!(started_among(&wedge) <= 1.001 * torque_drive().stiffness_n_per_m);
}

#[test]
fn walls_that_leave_no_free_space_are_felt_before_the_tip_is_in_them() {
    let shut = [(3.044, 2.05e-5), (0.0, 0.0), (4.3552, 2.68e-3)];
    assert!(started_among(&shut) <= 1.001 * torque_drive().stiffness_n_per_m);
}
