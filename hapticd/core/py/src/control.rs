//! Binding of the control crate's pure functions, for the numpy oracle and for analysis.

mod drive;
mod estimator;
mod friction;
mod kinematics;
mod law;
mod proxy;

use hapticd_control::environment::{self, SetPoint};
use hapticd_control::facing::Facing;
use hapticd_control::io::Axes;
use hapticd_control::linear::{self, M3, V3};
use hapticd_control::model::DeviceModel;
use hapticd_control::{contact, mapping};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A 3×3 matrix by rows.
pub(crate) type Rows = [Axes; 3];

/// Adds this module's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<kinematics::Kinematics>()?;
    module.add_class::<drive::SpringDrive>()?;
    module.add_class::<drive::TorqueDrive>()?;
    module.add_class::<estimator::Estimator>()?;
    module.add_class::<proxy::Proxy>()?;
    module.add_class::<friction::Friction>()?;
    module.add_class::<law::Law>()?;
    module.add_function(wrap_pyfunction!(lambda_max_sym, module)?)?;
    module.add_function(wrap_pyfunction!(find_contact, module)?)?;
    module.add_function(wrap_pyfunction!(set_point, module)?)?;
    module.add_function(wrap_pyfunction!(isotropic_stiffness, module)?)
}

/// Largest eigenvalue of a symmetric matrix.
#[pyfunction]
fn lambda_max_sym(matrix: Rows) -> f64 {
    linear::lambda_max_sym(&from_rows(&matrix))
}

/// Walls in contact, index of the deepest or `None`, its depth and its normal.
#[pyfunction]
#[pyo3(name = "contact")]
fn find_contact(walls: Vec<(Axes, f64, f64)>, x: Axes) -> (usize, Option<usize>, f64, Axes) {
    let found = contact::contact(&facings(&walls), &V3::from(x), &V3::from(x));
    let wall = (found.count > 0).then_some(found.wall);
    (found.count, wall, found.depth_m, found.normal.into())
}

/// Set-point of the tip and its velocity.
#[pyfunction]
fn set_point(walls: Vec<(Axes, f64, f64)>, x: Axes, xd: Axes) -> (Axes, Axes) {
    let SetPoint { x_sd, xd_sd } =
        environment::set_point(&facings(&walls), &V3::from(x), &V3::from(xd));
    (x_sd.into(), xd_sd.into())
}

/// Largest isotropic tip stiffness within the joint stiffnesses.
#[pyfunction]
fn isotropic_stiffness(jacobian: Rows, k_q: Axes) -> f64 {
    mapping::isotropic_stiffness(&from_rows(&jacobian), &V3::from(k_q))
}

fn facings(walls: &[(Axes, f64, f64)]) -> Vec<Facing> {
    let facing = |(wall, &(normal, offset_m, eta)): (usize, &(Axes, f64, f64))| Facing {
        wall,
        normal,
        offset_m,
        eta,
    };
    walls.iter().enumerate().map(facing).collect()
}

fn from_rows(rows: &Rows) -> M3 {
    M3::from_fn(|row, column| rows[row][column])
}

pub(crate) fn to_rows(matrix: &M3) -> Rows {
    matrix.transpose().into()
}

pub(crate) fn device_model(device_json: &str) -> PyResult<DeviceModel> {
    serde_json::from_str(device_json).map_err(value_error)
}

pub(crate) fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
