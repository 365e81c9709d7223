use crate::control::device_model;
use hapticd_control::io::Axes;
use hapticd_control::linear::M3;
use hapticd_control::model::BrakeModel;
use hapticd_control::scene::Allocation;
use hapticd_control::{allocate, brake};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Brake model of a device.
#[pyclass(module = "hapticd._core")]
pub struct Brakes(brake::Brakes);

#[pymethods]
impl Brakes {
    #[new]
    fn new(device_json: &str, period_s: f64) -> PyResult<Self> {
        Ok(Self(brake::Brakes::new(&brakes(device_json)?, period_s)))
    }

    /// Steps with the given torques asked; torques built up after it, without drag.
    fn step(&mut self, asked_nm: Axes) -> Axes {
        self.0.step(&asked_nm.into());
        self.0.torque_nm().into()
    }
}

/// Motor and brake allocation of a device.
#[pyclass(module = "hapticd._core")]
pub struct Allocator(allocate::Allocator);

#[pymethods]
impl Allocator {
    #[new]
    fn new(device_json: &str, period_s: f64) -> PyResult<Self> {
        Ok(Self(allocate::Allocator::new(
            &brakes(device_json)?,
            period_s,
        )))
    }

    /// Motor torques, brake torques and which brakes are usable.
    #[pyo3(signature = (mode, *, jacobian_inverse, force_n, torque_nm, qd, hand_force_n, hand_torque_nm, brake_nm))]
    #[allow(clippy::too_many_arguments)] // keywords in Python
    fn split(
        &mut self,
        mode: &str,
        jacobian_inverse: [Axes; 3],
        force_n: Axes,
        torque_nm: Axes,
        qd: Axes,
        hand_force_n: Axes,
        hand_torque_nm: Axes,
        brake_nm: Axes,
    ) -> PyResult<(Axes, Axes, [bool; 3])> {
        let load = allocate::Load {
            torque_nm: torque_nm.into(),
            force_n: force_n.into(),
            // Rows of J⁻¹ are the columns of J⁻ᵀ.
            force_per_torque: M3::from(jacobian_inverse),
            qd: qd.into(),
            hand_torque_nm: hand_torque_nm.into(),
            hand_force_n: hand_force_n.into(),
            brake_nm: brake_nm.into(),
            ..allocate::Load::default()
        };
        let split = self.0.split(allocation(mode)?, &load);
        Ok((split.motor_nm.into(), split.brake_nm.into(), split.usable))
    }
}

fn allocation(mode: &str) -> PyResult<Allocation> {
    let value = serde_json::Value::String(mode.to_owned());
    serde_json::from_value(value).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn brakes(device_json: &str) -> PyResult<BrakeModel> {
    device_model(device_json)?
        .brakes
        .ok_or_else(|| PyValueError::new_err("the device has no brakes"))
}
