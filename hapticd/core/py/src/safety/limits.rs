use crate::control::device_model;
use hapticd_control::actuator::Supply;
use hapticd_control::bound;
use hapticd_control::io::Axes;
use hapticd_control::linear::{M3, V3};
use pyo3::prelude::*;

/// Bounded joint torque and the limits that acted. `supply` is back-EMF, volts per N·m and
/// largest volts.
#[pyfunction]
#[pyo3(signature = (device_json, asked_nm, *, period_s, fade, jacobian_inverse, peak_nm, present_nm, retain, supply=None))]
#[allow(clippy::too_many_arguments)] // keywords in Python
pub fn bound_motor(
    device_json: &str,
    asked_nm: Axes,
    period_s: f64,
    fade: f64,
    jacobian_inverse: [Axes; 3],
    peak_nm: Axes,
    present_nm: Axes,
    retain: Axes,
    supply: Option<[Axes; 3]>,
) -> PyResult<(Axes, u64)> {
    let bounds = bound::Bounds {
        limits: &device_model(device_json)?.limits,
        period_s,
        fade,
        jacobian_inverse: &M3::from_fn(|row, column| jacobian_inverse[row][column]),
        peak_nm: peak_nm.into(),
        present_nm: present_nm.into(),
        retain: retain.into(),
        supply: supply.map(|[emf_v, v_per_nm, max_v]| Supply {
            emf_v: emf_v.into(),
            v_per_nm: v_per_nm.into(),
            max_v: max_v.into(),
        }),
    };
    let bounded = bound::bound_motor(&V3::from(asked_nm), &bounds);
    Ok((bounded.torque_nm.into(), bounded.acted))
}

/// Bounded torque of one brake.
#[pyfunction]
#[pyo3(signature = (*, asked_nm, before_nm, wanted_nm, qd, max_nm, rise_nm, omega_off))]
pub fn bound_brake(
    asked_nm: f64,
    before_nm: f64,
    wanted_nm: f64,
    qd: f64,
    max_nm: f64,
    rise_nm: f64,
    omega_off: f64,
) -> f64 {
    bound::bound_brake(&bound::BrakeAsk {
        asked_nm,
        before_nm,
        wanted_nm,
        qd,
        max_nm,
        rise_nm,
        omega_off,
    })
}

/// Factor on the outputs near a singularity.
#[pyfunction]
pub fn singularity_fade(margin: f64, margin_limit: f64) -> f64 {
    bound::singularity_fade(margin, margin_limit)
}
