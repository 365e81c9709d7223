use super::{device_model, value_error};
use hapticd_control::estimate::JointState;
use hapticd_control::friction::{FrictionRenderer, Rubbing};
use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use hapticd_control::model::KinematicsModel;
use hapticd_control::scene;
use pyo3::prelude::*;
use serde::de::value::{Error, StrDeserializer};
use serde::Deserialize;

/// A wall as Python gives it: key, normal, rendered normal force, μ_s, μ_k, actuator.
type PlainWall = (u64, Axes, f64, f64, f64, String);

/// Friction of one device model, with its memory.
#[pyclass(module = "hapticd._core")]
pub struct Friction {
    kinematics: KinematicsModel,
    renderer: FrictionRenderer,
}

#[pymethods]
impl Friction {
    #[new]
    fn new(device_json: &str, period_s: f64) -> PyResult<Self> {
        let model = device_model(device_json)?;
        Ok(Self {
            kinematics: model.kinematics,
            renderer: FrictionRenderer::new(&model, period_s),
        })
    }

    /// Force for the motors, force for the brakes, and the state after one more tick.
    #[pyo3(signature = (walls, *, q, x, xd, hand_force_n = None))]
    fn force(
        &mut self,
        walls: Vec<PlainWall>,
        q: Axes,
        x: Axes,
        xd: Axes,
        hand_force_n: Option<Axes>,
    ) -> PyResult<(Axes, Axes, u64)> {
        let walls = walls.iter().map(rubbing).collect::<PyResult<Vec<_>>>()?;
        let mut state = JointState::at(&self.kinematics, q.into(), V3::zeros());
        state.x = x.into();
        state.xd = xd.into();
        let hand_force_n = hand_force_n.map(V3::from);
        let found = self.renderer.force(&walls, &state, hand_force_n.as_ref());
        Ok((
            found.motor_n.into(),
            found.brake_n.into(),
            found.state as u64,
        ))
    }

    /// Energy in the anchors, J.
    fn energy_j(&self) -> f64 {
        self.renderer.energy_j()
    }
}

fn rubbing(wall: &PlainWall) -> PyResult<Rubbing> {
    let (key, normal, normal_n, static_, kinetic, actuator) = wall;
    let name = StrDeserializer::<Error>::new(actuator);
    Ok(Rubbing {
        key: *key,
        normal: (*normal).into(),
        normal_n: *normal_n,
        friction: scene::Friction {
            static_: *static_,
            kinetic: *kinetic,
            actuator: scene::FrictionActuator::deserialize(name).map_err(value_error)?,
        },
    })
}
