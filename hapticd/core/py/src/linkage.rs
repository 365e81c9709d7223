//! Binding of the twins' linkages, for analysis.

use crate::control::{device_model, to_rows, value_error, Rows};
use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use hapticd_control::model::{DriveModel, KinematicsModel};
use hapticd_twin::linkage::{Linkage, PhantomLinkage, RhombusLinkage};
use hapticd_twin::TwinModel;
use pyo3::prelude::*;

/// Adds this module's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(mass_matrix, module)?)
}

/// M(q), kg·m² by rows, rotors included; an unused joint has a mass of its own.
#[pyfunction]
fn mass_matrix(device_json: &str, twin_json: &str, q: Axes) -> PyResult<Rows> {
    let device = device_model(device_json)?;
    let twin: TwinModel = serde_json::from_str(twin_json).map_err(value_error)?;
    let q = V3::from(q);
    let mass = match (&twin, device.kinematics, &device.drive) {
        (
            TwinModel::Phantom(twin),
            KinematicsModel::Phantom { l1_m, l2_m, .. },
            DriveModel::Spring(drive),
        ) => PhantomLinkage::new(
            &twin.linkage,
            l1_m,
            l2_m,
            &drive.ratio,
            twin.winding.rotor_kg_m2,
        )
        .mass(&q),
        (TwinModel::Hhd(twin), KinematicsModel::Rhombus { l_m, .. }, _) => {
            RhombusLinkage::new(&twin.linkage, l_m).mass(&q)
        }
        _ => return Err(value_error("the twin does not fit the device")),
    };
    Ok(to_rows(&mass))
}
