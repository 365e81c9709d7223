//! Binding of the safety layer's formulas, for the numpy oracle.

mod allocation;
mod energy;
mod limits;
mod motor;

use pyo3::prelude::*;

/// Adds this module's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<energy::Ledger>()?;
    module.add_class::<motor::Thermal>()?;
    module.add_class::<motor::Budget>()?;
    module.add_class::<allocation::Brakes>()?;
    module.add_class::<allocation::Allocator>()?;
    module.add_function(wrap_pyfunction!(limits::bound_motor, module)?)?;
    module.add_function(wrap_pyfunction!(limits::bound_brake, module)?)?;
    module.add_function(wrap_pyfunction!(limits::singularity_fade, module)?)
}
