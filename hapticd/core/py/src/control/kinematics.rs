use super::{device_model, to_rows, value_error, Rows};
use hapticd_control::environment::SetPoint;
use hapticd_control::estimate::JointState;
use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use hapticd_control::mapping::{joint_set_point, workspace_stiffness};
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::Mapping;
use pyo3::prelude::*;
use serde::de::value::{Error, StrDeserializer};
use serde::Deserialize;

/// Geometry of one device model.
#[pyclass(frozen, module = "hapticd._core")]
pub struct Kinematics {
    model: DeviceModel,
}

#[pymethods]
impl Kinematics {
    #[new]
    fn new(device_json: &str) -> PyResult<Self> {
        let model = device_model(device_json)?;
        Ok(Self { model })
    }

    fn forward(&self, q: Axes) -> Axes {
        self.model.kinematics.forward(&V3::from(q)).into()
    }

    fn inverse(&self, x: Axes) -> Option<Axes> {
        self.model.kinematics.inverse(&V3::from(x)).map(Axes::from)
    }

    fn jacobian(&self, q: Axes) -> Rows {
        to_rows(&self.model.kinematics.jacobian(&V3::from(q)))
    }

    fn jacobian_inverse(&self, q: Axes) -> Option<Rows> {
        let inverse = self.model.kinematics.jacobian_inverse(&V3::from(q));
        inverse.as_ref().map(to_rows)
    }

    fn singularity_margin(&self, q: Axes) -> f64 {
        self.model.kinematics.singularity_margin(&V3::from(q))
    }

    fn inside(&self, q: Axes, margin_rad: f64) -> bool {
        let DeviceModel {
            kinematics, joints, ..
        } = &self.model;
        kinematics.inside(joints, &V3::from(q), margin_rad)
    }

    fn workspace_stiffness(&self, k_q: Axes) -> f64 {
        workspace_stiffness(&self.model, &V3::from(k_q))
    }

    #[pyo3(signature = (mapping, *, q, qd, x_sd, xd_sd, k_q, k_c))]
    #[allow(clippy::too_many_arguments)] // one keyword each of a test's call
    fn joint_set_point(
        &self,
        mapping: &str,
        q: Axes,
        qd: Axes,
        x_sd: Axes,
        xd_sd: Axes,
        k_q: Axes,
        k_c: f64,
    ) -> PyResult<(Axes, Axes)> {
        let name = StrDeserializer::<Error>::new(mapping);
        let mapping = Mapping::deserialize(name).map_err(value_error)?;
        let kinematics = &self.model.kinematics;
        let state = JointState::at(kinematics, q.into(), qd.into());
        let set_point = SetPoint {
            x_sd: x_sd.into(),
            xd_sd: xd_sd.into(),
        };
        let found = joint_set_point(mapping, kinematics, &state, &set_point, &k_q.into(), k_c);
        Ok((found.q_sd.into(), found.qd_sd.into()))
    }
}
