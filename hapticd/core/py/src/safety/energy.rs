use hapticd_control::energy;
use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use pyo3::prelude::*;

/// Energy that the motors of a device took from the hand.
#[pyclass(module = "hapticd._core")]
pub struct Ledger(energy::Ledger);

#[pymethods]
impl Ledger {
    #[new]
    fn new(period_s: f64) -> Self {
        Self(energy::Ledger::new(period_s))
    }

    /// One period between two joint torques; `measured` ones need not be delayed.
    fn advance(&mut self, before_nm: Axes, after_nm: Axes, retain: Axes, measured: bool) {
        self.0.advance(&energy::Span {
            before_nm: before_nm.into(),
            after_nm: after_nm.into(),
            retain: retain.into(),
            measured,
        });
    }

    /// Books what the joints moved since the last frame; the device's energy after it.
    fn book(&mut self, step_rad: Axes) -> f64 {
        self.0.book(&step_rad.into(), &V3::zeros());
        self.0.device_j()
    }
}
