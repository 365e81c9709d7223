//! The whole tick on a rubbing wall.

use crate::models::{hhd, phantom};
use crate::rig::{scene, tip_force_n, Rig};
use hapticd_control::io::status;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::flag;
use hapticd_control::scene::{Allocation, Friction, FrictionActuator, Scene, Wall};

const STICK: u64 = 1;
const SLIP: u64 = 2;

/// A device whose tip is led over a wall below it, all forces along the coordinates.
struct Surface {
    rig: Rig,
    x: V3,
    /// Along the wall.
    t: V3,
    /// Out of the wall.
    n: V3,
}

impl Surface {
    fn new(model: DeviceModel, depth_m: f64, friction: Friction, allocation: Allocation) -> Self {
        let (t, n) = if model.dof == 2 {
            (V3::x(), V3::y())
        } else {
            (V3::y(), V3::z())
        };
        let mut rig = Rig::running(model);
        let x = V3::from(rig.record.tip_position_m);
        let wall = Wall {
            friction,
            brake: false,
            ..Wall::plane(1, n.into(), n.dot(&x) + depth_m, 0.0)
        };
        rig.controller.adopt(&Scene {
            allocation,
            ..scene(&[wall], 0.0)
        });
        let mut surface = Self { rig, x, t, n };
        surface.press(20.0, 0.0);
        surface.lead(0.0, 100);
        surface
    }

    /// The hand presses on the wall and pulls along it, N.
    fn press(&mut self, push_n: f64, pull_n: f64) {
        if self.rig.model.limits.sensor_force_n > 0.0 {
            self.rig.hand(pull_n * self.t - push_n * self.n);
        }
    }

    /// Leads the tip along the wall, m a tick.
    fn lead(&mut self, step_m: f64, ticks: usize) {
        for _ in 0..ticks {
            self.x += step_m * self.t;
            let q = self.rig.model.kinematics.inverse(&self.x);
            self.rig.place(&q.expect("tip is in reach"));
            self.rig.step();
        }
    }

    fn friction_n(&self) -> V3 {
        self.rig.record.friction_force_n.into()
    }
}

fn rough(actuator: FrictionActuator) -> Friction {
    Friction {
        static_: 0.6,
        kinetic: 0.4,
        actuator,
    }
}

#[test]
fn motors_hold_a_stuck_tip_and_rub_a_sliding_one_on_both_devices() {
    for (model, depth_m) in [(hhd(), 0.0003), (phantom(), 0.001)] {
        let auto = rough(FrictionActuator::Auto);
        let mut surface = Surface::new(model, depth_m, auto, Allocation::MotorOnly);
        surface.lead(1e-5, 15);
        assert_eq!(surface.rig.record.friction_state, STICK);
        assert_ne!(surface.rig.record.flags & flag::STICK, 0);
        let held_n = surface.friction_n();
        assert!(held_n.dot(&surface.t) < -0.1, "{held_n}");
        let given_n = tip_force_n(&surface.rig.record);
        assert!((given_n.dot(&surface.t) - held_n.dot(&surface.t)).abs() < 0.1 * held_n.norm());
        surface.lead(1e-4, 200);
        assert_eq!(surface.rig.record.friction_state, SLIP);
        assert_eq!(surface.rig.record.flags & flag::STICK, 0);
        let rubbed_n = -surface.friction_n().dot(&surface.t);
        let pressed_n = tip_force_n(&surface.rig.record).dot(&surface.n);
        let measured = surface.rig.model.limits.sensor_force_n > 0.0;
        let normal_n = if measured { 20.0 } else { pressed_n };
        assert!(
            (rubbed_n / normal_n - 0.4).abs() < 0.04,
            "{rubbed_n} of {normal_n}"
        );
    }
}

#[test]
fn brakes_rub_where_there_are_any_and_motors_only_press() {
    let auto = rough(FrictionActuator::Auto);
    let mut surface = Surface::new(hhd(), 0.0003, auto, Allocation::MotorAndBrake);
    surface.lead(1e-4, 300);
    assert_eq!(surface.rig.record.friction_state, SLIP);
    let asked_nm = V3::from(surface.rig.command.brake_torque_nm);
    let wanted_nm = V3::from(surface.rig.record.hold_torque_nm).abs();
    assert!(wanted_nm.min().max(wanted_nm.x) > 0.3);
    assert!(
        (asked_nm - wanted_nm).norm() < 1e-9,
        "{asked_nm} {wanted_nm}"
    );
    let along_n = tip_force_n(&surface.rig.record).dot(&surface.t);
    assert!(
        along_n > -0.5,
        "motors do not rub beside the brakes: {along_n}"
    );
}

#[test]
fn brakes_are_charged_against_a_pull_that_the_normal_force_covers() {
    // On joint 2 the hand's push outweighs its pull: what the brake meets is the hand and the motors
    // together, and that is the pull.
    let auto = rough(FrictionActuator::Auto);
    let mut surface = Surface::new(hhd(), 0.0003, auto, Allocation::MotorAndBrake);
    surface.press(18.0, 6.0);
    surface.lead(0.0, 100);
    assert_eq!(surface.rig.record.friction_state, STICK);
    assert_eq!(surface.rig.record.brake_usable, 0b11);
    let asked_nm = V3::from(surface.rig.command.brake_torque_nm);
    let capacity_nm = surface.rig.record.hold_torque_nm;
    assert!((asked_nm - V3::from(capacity_nm).abs()).norm() < 1e-9);
    assert!(asked_nm.x > 0.5 && asked_nm.y > 0.5, "{asked_nm}");
}

#[test]
fn hand_that_lets_go_takes_the_friction_with_it() {
    for allocation in [Allocation::MotorOnly, Allocation::MotorAndBrake] {
        let auto = rough(FrictionActuator::Auto);
        let mut surface = Surface::new(hhd(), 0.0003, auto, allocation);
        surface.press(20.0, 5.0);
        surface.lead(1e-5, 15);
        assert!(surface.friction_n().norm() > 1.0);
        surface.press(0.0, 0.0);
        surface.lead(0.0, 30);
        assert!(surface.friction_n().norm() < 1e-3);
        assert!(V3::from(surface.rig.command.brake_torque_nm).amax() < 1e-3);
    }
}

#[test]
fn friction_of_a_faulty_sensor_follows_the_rendered_force() {
    let motor = rough(FrictionActuator::Motor);
    let mut surface = Surface::new(hhd(), 0.0003, motor, Allocation::MotorOnly);
    surface.rig.observation.status ^= status::SENSOR_SATURATED;
    surface.lead(1e-4, 40);
    // 60 kN/m at 0.3 mm: the fade out of the fault has not ended.
    let rubbed_n = surface.friction_n().norm();
    assert!((rubbed_n - 0.4 * 18.0).abs() < 1.5, "{rubbed_n}");
}

#[test]
fn no_friction_coefficient_passes_the_limits_of_the_tip() {
    for (model, depth_m) in [(hhd(), 0.0003), (phantom(), 0.001)] {
        let endless = Friction {
            static_: 1e3,
            kinetic: 1e3,
            actuator: FrictionActuator::Motor,
        };
        let limits = model.limits;
        let mut surface = Surface::new(model, depth_m, endless, Allocation::MotorOnly);
        for _ in 0..200 {
            surface.lead(2e-4, 1);
            let sent_n = tip_force_n(&surface.rig.record);
            assert!(sent_n.norm() <= limits.tip_force_n * (1.0 + 1e-9));
            assert_eq!(surface.rig.record.faults, 0);
        }
    }
}
