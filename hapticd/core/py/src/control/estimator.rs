use super::device_model;
use hapticd_control::estimate;
use hapticd_control::io::Axes;
use pyo3::prelude::*;

/// Velocity estimate of one device model.
#[pyclass(module = "hapticd._core")]
pub struct Estimator {
    estimator: estimate::Estimator,
}

#[pymethods]
impl Estimator {
    #[new]
    fn new(device_json: &str) -> PyResult<Self> {
        let estimator = estimate::Estimator::new(&device_model(device_json)?);
        Ok(Self { estimator })
    }

    fn reset(&mut self, counts: [i64; 3]) {
        self.estimator.reset(&counts);
    }

    /// q, q̇, x, ẋ after one more frame.
    fn update(&mut self, counts: [i64; 3], dt_s: f64) -> [Axes; 4] {
        let state = self.estimator.update(&counts, dt_s);
        [state.q, state.qd, state.x, state.xd].map(Axes::from)
    }
}
