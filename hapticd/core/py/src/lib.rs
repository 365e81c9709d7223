//! `hapticd._core`: the binding. Converts, calls, maps errors; nothing is decided here.

use pyo3::prelude::*;

mod control;
mod driver;
mod front;
mod linkage;
mod parking;
mod safety;
mod schema;
mod servo;
mod twin;

/// Rust core of hapticd.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    schema::register(module)?;
    safety::register(module)?;
    control::register(module)?;
    twin::register(module)?;
    linkage::register(module)?;
    front::register(module)?;
    servo::register(module)?;
    Ok(())
}
