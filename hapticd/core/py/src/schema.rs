//! The core's tables: what a tick record holds, what faults and interlocks mean, how it was built.

use hapticd_control::fault::{Severity, FAULTS};
use hapticd_control::interlock::INTERLOCKS;
use hapticd_control::record::{Kind, FIELDS};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Adds this module's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(tick_schema, module)?)?;
    module.add_function(wrap_pyfunction!(fault_table, module)?)?;
    module.add_function(wrap_pyfunction!(interlock_table, module)?)?;
    module.add_function(wrap_pyfunction!(build_info, module)?)
}

/// Fields of a tick record in memory order.
#[pyfunction]
fn tick_schema(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let rows = FIELDS.iter().map(|field| {
        let row = PyDict::new(py);
        row.set_item("name", field.name)?;
        row.set_item("kind", kind_name(field.kind))?;
        row.set_item("words", field.words)?;
        row.set_item("unit", field.unit)?;
        row.set_item("meaning", field.meaning)?;
        Ok(row)
    });
    PyList::new(py, rows.collect::<PyResult<Vec<_>>>()?)
}

/// Every fault in bit order.
#[pyfunction]
fn fault_table(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let rows = FAULTS.iter().map(|info| {
        let row = PyDict::new(py);
        row.set_item("slug", info.slug)?;
        row.set_item("severity", severity_name(info.severity))?;
        row.set_item("cause", info.cause)?;
        row.set_item("cure", info.cure)?;
        Ok(row)
    });
    PyList::new(py, rows.collect::<PyResult<Vec<_>>>()?)
}

/// Every interlock in bit order.
#[pyfunction]
fn interlock_table(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let rows = INTERLOCKS.iter().map(|info| {
        let row = PyDict::new(py);
        row.set_item("slug", info.slug)?;
        row.set_item("why", info.why)?;
        row.set_item("cure", info.cure)?;
        Ok(row)
    });
    PyList::new(py, rows.collect::<PyResult<Vec<_>>>()?)
}

/// How the core was built, for bug reports.
#[pyfunction]
fn build_info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("version", env!("CARGO_PKG_VERSION"))?;
    info.set_item(
        "profile",
        if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        },
    )?;
    info.set_item(
        "platform",
        format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
    )?;
    Ok(info)
}

fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Float => "float",
        Kind::Unsigned => "unsigned",
    }
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::StopNow => "stop_now",
        Severity::SoftStop => "soft_stop",
        Severity::BlocksEnabling => "blocks_enabling",
    }
}
