//! Excitation of the set-point, for identification.

use crate::environment::SetPoint;
use crate::linear::V3;
use crate::scene::Probe;
use core::f64::consts::TAU;

/// What a probe adds to the tip's set-point and its velocity `t_s` after the start:
/// a sin(2πft) and its derivative along its direction.
#[must_use]
pub fn excitation(probe: &Probe, t_s: f64) -> SetPoint {
    let omega = TAU * probe.frequency_hz;
    let direction = V3::from(probe.direction);
    SetPoint {
        x_sd: probe.amplitude_m * (omega * t_s).sin() * direction,
        xd_sd: probe.amplitude_m * omega * (omega * t_s).cos() * direction,
    }
}
