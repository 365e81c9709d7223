//! How walls answer penetration.

use crate::scene::Law;

/// Share of the penetration that a wall lets pass where a rigid one has the stiffness `k_c`, N/m:
/// η of a motion law (WN eq. 30).
#[must_use]
pub fn eta(law: &Law, k_c: f64) -> f64 {
    match *law {
        Law::Motion { eta } => eta,
        Law::Spring {
            stiffness_n_per_m, ..
        } if k_c > 0.0 => (1.0 - stiffness_n_per_m / k_c).clamp(0.0, 1.0),
        Law::Spring { .. } | Law::Damper { .. } | Law::CubicDamper { .. } => 1.0,
    }
}
