//! The motion law: the set-point penetrates by η times the depth (WN eq. 17, 30).

/// Share of the stiffness of a rigid wall: 1 − η.
#[must_use]
pub fn rigid_part(eta: f64) -> f64 {
    1.0 - eta
}
