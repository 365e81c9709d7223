//! The side of a wall is the one on which the tip is when force begins.

use crate::models::{hhd, phantom};
use crate::rig::{ask, fade_out, scene, tip_force_n, Rig, RATE_HZ};
use hapticd_control::controller::Event;
use hapticd_control::io::Exchange;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::{Shape, Wall};

/// Longest way of the tip in a tick, m.
const STEP_M: f64 = 0.0005;

fn wall(shape: Shape) -> Wall {
    Wall {
        shape,
        ..Wall::plane(1, [0.0, 1.0, 0.0], 0.0, 0.0)
    }
}

/// A plate across y whose middle is `y_m` from home.
fn plate(rig: &Rig, y_m: f64, half_m: f64) -> Wall {
    wall(Shape::Box {
        center_m: (tip_at_home(rig) + y_m * V3::y()).into(),
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        half_m: [1.0, half_m, 1.0],
        hollow: false,
    })
}

fn tip_at_home(rig: &Rig) -> V3 {
    rig.model.kinematics.forward(&rig.home())
}

/// Takes the tip along y from home.
fn take(rig: &mut Rig, from_m: f64, to_m: f64) {
    let count = ((to_m - from_m).abs() / STEP_M).ceil();
    for step in 1..=count as usize {
        put(rig, from_m + (to_m - from_m) * step as f64 / count);
        rig.step();
    }
}

/// Puts the tip `y_m` along y from home.
fn put(rig: &mut Rig, y_m: f64) {
    let x = tip_at_home(rig) + y_m * V3::y();
    let q = rig.model.kinematics.inverse(&x).expect("in reach");
    rig.place(&q);
}

/// A device at home in front of `wall`, whose outputs are off.
fn idle(model: DeviceModel, wall: impl Fn(&Rig) -> Wall) -> Rig {
    let mut rig = Rig::new(model);
    let wall = wall(&rig);
    rig.controller.adopt(&scene(&[wall], 0.0));
    rig.steps(5);
    rig
}

fn ramp_up(rig: &mut Rig) {
    ask(rig, Event::Enable);
    rig.steps((rig.model.limits.ramp_s * RATE_HZ) as usize + 10);
    assert_eq!(rig.record.gain, 1.0);
}

#[test]
fn tip_taken_through_a_thin_wall_while_disabled_is_not_pulled_back() {
    for model in [phantom(), hhd()] {
        let mut rig = idle(model, |rig| plate(rig, 0.005, 0.0005));
        take(&mut rig, 0.0, 0.01);
        ramp_up(&mut rig);
        assert!(tip_force_n(&rig.record).norm() < 1e-9);
        take(&mut rig, 0.01, 0.0049);
        rig.steps(50);
        assert!(tip_force_n(&rig.record).y > 0.5, "{:?}", rig.record);
    }
}

#[test]
fn tip_taken_out_of_a_hollow_ball_while_disabled_is_not_pulled_back() {
    for model in [phantom(), hhd()] {
        let mut rig = idle(model, |rig| {
            wall(Shape::Sphere {
                center_m: tip_at_home(rig).into(),
                radius_m: 0.005,
                hollow: true,
            })
        });
        take(&mut rig, 0.0, 0.01);
        ramp_up(&mut rig);
        assert!(tip_force_n(&rig.record).norm() < 1e-9);
        take(&mut rig, 0.01, 0.004);
        rig.steps(50);
        assert!(tip_force_n(&rig.record).y > 0.5, "felt from outside now");
    }
}

#[test]
fn tip_taken_through_a_wall_while_paused_is_not_pulled_back() {
    let mut rig = idle(phantom(), |rig| plate(rig, 0.005, 0.0005));
    ramp_up(&mut rig);
    ask(&mut rig, Event::Pause);
    let _ = fade_out(&mut rig);
    take(&mut rig, 0.0, 0.01);
    ramp_up(&mut rig);
    assert!(tip_force_n(&rig.record).norm() < 1e-9);
}

#[test]
fn tip_taken_through_a_wall_before_the_board_drives_is_not_pulled_back() {
    let mut rig = idle(phantom(), |rig| plate(rig, 0.005, 0.0005));
    rig.obeys = false;
    ask(&mut rig, Event::Enable);
    take(&mut rig, 0.0, 0.01);
    rig.obeys = true;
    rig.steps((rig.model.limits.ramp_s * RATE_HZ) as usize + 10);
    assert_eq!(rig.record.gain, 1.0);
    assert!(tip_force_n(&rig.record).norm() < 1e-9);
}

#[test]
fn tip_enabled_within_a_solid_is_pushed_to_its_nearest_face_by_a_ramp() {
    for model in [phantom(), hhd()] {
        let mut rig = idle(model, |rig| plate(rig, 0.01, 0.005));
        take(&mut rig, 0.0, 0.012);
        ask(&mut rig, Event::Enable);
        let mut largest_n: f64 = 0.0;
        for _ in 0..(rig.model.limits.ramp_s * RATE_HZ) as usize + 10 {
            let before_n = tip_force_n(&rig.record);
            rig.step();
            largest_n = largest_n.max((tip_force_n(&rig.record) - before_n).norm());
        }
        let force_n = tip_force_n(&rig.record);
        assert!(force_n.y > 0.9 * force_n.norm() && force_n.y > 0.5);
        assert!(largest_n < 0.02 * force_n.norm(), "{largest_n}");
    }
}

#[test]
fn missing_frames_do_not_lose_the_side_of_a_wall() {
    for model in [phantom(), hhd()] {
        let mut rig = idle(model, |rig| plate(rig, 0.001, 0.0005));
        ramp_up(&mut rig);
        for _ in 0..rig.model.limits.missing_ticks {
            rig.exchange(Exchange::Missing);
        }
        put(&mut rig, 0.0014);
        rig.step();
        rig.steps(50);
        assert!(tip_force_n(&rig.record).y < -0.5, "{:?}", rig.record);
    }
}
