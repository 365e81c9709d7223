//! A tip that is led along a path over walls, tick by tick.

use hapticd_control::estimate::JointState;
use hapticd_control::friction::{FrictionForce, FrictionRenderer, Rubbing};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::{Friction, FrictionActuator};
use proptest::prelude::*;

pub const PERIOD_S: f64 = 1e-3;
pub const STATIC: f64 = 0.6;
pub const KINETIC: f64 = 0.4;

fn parse(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

pub fn phantom() -> DeviceModel {
    parse(include_str!("../../../../devices/phantom-1.0.toml"))
}

pub fn hhd() -> DeviceModel {
    parse(include_str!("../../../../devices/hhd.toml"))
}

pub fn friction(actuator: FrictionActuator) -> Friction {
    Friction {
        static_: STATIC,
        kinetic: KINETIC,
        actuator,
    }
}

/// A wall of the given normal with friction by the motors.
pub fn wall(key: u64, normal: V3, normal_n: f64) -> Rubbing {
    Rubbing {
        key,
        normal,
        normal_n,
        friction: friction(FrictionActuator::Motor),
    }
}

/// The friction of one device, led along a path.
pub struct Rubber {
    pub friction: FrictionRenderer,
    state: JointState,
}

impl Rubber {
    pub fn new(model: &DeviceModel) -> Self {
        let home = V3::from(model.joints.home_rad);
        Self {
            friction: FrictionRenderer::new(model, PERIOD_S),
            state: JointState::at(&model.kinematics, home, V3::zeros()),
        }
    }

    /// Friction after a step of the tip, m.
    pub fn step(&mut self, step_m: &V3, walls: &[Rubbing], hand_n: Option<&V3>) -> FrictionForce {
        self.state.x += step_m;
        self.state.xd = step_m / PERIOD_S;
        self.friction.force(walls, &self.state, hand_n)
    }

    /// The same step several times; the last force.
    pub fn steps(&mut self, count: usize, step_m: &V3, walls: &[Rubbing]) -> FrictionForce {
        let mut last = FrictionForce::default();
        for _ in 0..count {
            last = self.step(step_m, walls, None);
        }
        last
    }
}

/// A unit vector, and one across it; in a plane half of the time.
pub fn surface() -> impl Strategy<Value = (V3, V3)> {
    let axis = || -1.0..1.0_f64;
    let vectors = ([axis(), axis(), axis()], [axis(), axis(), axis()]);
    (vectors, any::<bool>()).prop_filter_map("a normal and a tangent", |((n, t), flat)| {
        let (mut n, mut t) = (V3::from(n), V3::from(t));
        if flat {
            (n.z, t.z) = (0.0, 0.0);
        }
        let n = n.try_normalize(0.1)?;
        let t = (t - n * n.dot(&t)).try_normalize(0.1)?;
        Some((n, t))
    })
}

/// Steps of up to 0.3 mm, and the normal force in each, N.
pub fn path() -> impl Strategy<Value = Vec<(V3, f64)>> {
    let axis = || -3e-4..3e-4_f64;
    let step = [axis(), axis(), axis()].prop_map(V3::from);
    let normal_n = prop_oneof![1 => Just(0.0), 4 => 0.0..50.0_f64];
    prop::collection::vec((step, normal_n), 1..80)
}

/// Either device.
pub fn device() -> impl Strategy<Value = DeviceModel> {
    any::<bool>().prop_map(|spatial| if spatial { phantom() } else { hhd() })
}
