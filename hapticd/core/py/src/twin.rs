//! Binding of the twin crate.

use pyo3::prelude::*;

/// Adds this module's names to `hapticd._core`.
pub fn register(_module: &Bound<'_, PyModule>) -> PyResult<()> {
    Ok(())
}
