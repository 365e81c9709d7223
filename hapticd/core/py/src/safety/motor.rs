use crate::control::device_model;
use hapticd_control::io::Axes;
use hapticd_control::model::DriveModel;
use hapticd_control::{budget, thermal};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Winding temperatures of a device with spring drives.
#[pyclass(module = "hapticd._core")]
pub struct Thermal(thermal::Thermal);

#[pymethods]
impl Thermal {
    #[new]
    fn new(device_json: &str, period_s: f64) -> PyResult<Self> {
        match device_model(device_json)?.drive {
            DriveModel::Spring(drive) => Ok(Self(thermal::Thermal::new(&drive, period_s))),
            DriveModel::Torque(_) => Err(PyValueError::new_err("the device has torque drives")),
        }
    }

    /// Steps with the given currents; winding temperatures and residual resistances after it.
    fn step(&mut self, current_a: Axes) -> (Axes, Axes) {
        self.0.step(&current_a.into());
        (self.0.winding_c().into(), self.0.residual_ohm().into())
    }
}

/// I²t budget.
#[pyclass(module = "hapticd._core")]
pub struct Budget(budget::Budget);

#[pymethods]
impl Budget {
    #[new]
    #[pyo3(signature = (*, peak, continuous, peak_time_s, period_s))]
    fn new(peak: Axes, continuous: Axes, peak_time_s: f64, period_s: f64) -> Self {
        let rating = budget::Rating {
            peak,
            continuous,
            peak_time_s,
        };
        Self(budget::Budget::new(rating, period_s))
    }

    /// Steps under the given load; budget used and limit after it.
    fn step(&mut self, load: Axes) -> (Axes, Axes) {
        self.0.step(&load.into());
        (self.0.used().into(), self.0.limit().into())
    }
}
