use super::{device_model, value_error};
use hapticd_control::law::{self, Tip};
use hapticd_control::scene;
use pyo3::prelude::*;

/// One wall's law on one device model.
#[pyclass(frozen, module = "hapticd._core")]
pub struct Law {
    law: scene::Law,
    tip: Tip,
}

#[pymethods]
impl Law {
    #[new]
    fn new(device_json: &str, law_json: &str, period_s: f64) -> PyResult<Self> {
        Ok(Self {
            law: serde_json::from_str(law_json).map_err(value_error)?,
            tip: Tip::new(&device_model(device_json)?, period_s),
        })
    }

    /// Stiffness and damping of the wall's spring, where a rigid wall has the given ones.
    fn spring(&self, rigid_n_per_m: f64, rigid_n_s_per_m: f64) -> (f64, f64) {
        (
            law::stiffness(&self.law, rigid_n_per_m),
            law::damping(&self.law, rigid_n_s_per_m),
        )
    }

    fn eta(&self, rigid_n_per_m: f64, reference_n_per_m: f64) -> f64 {
        law::eta(&self.law, rigid_n_per_m, reference_n_per_m)
    }

    fn damper_force(&self, closing_m_per_s: f64) -> f64 {
        law::damper_force(&self.law, closing_m_per_s, &self.tip)
    }
}
