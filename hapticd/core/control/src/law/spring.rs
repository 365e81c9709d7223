//! A spring with a damper beside it (KS §4).

use crate::linear::V3;

/// Share of the dampers' force, at most 1, at which springs and dampers together do not pull: the
/// largest s with (spring + s·damper)·spring ≥ 0; 0 without a spring force.
///
/// Scaled as a whole the dampers stay dissipative, also at a corner.
#[must_use]
pub fn damper_share(spring_n: &V3, damper_n: &V3) -> f64 {
    let push = spring_n.norm_squared();
    let pull = -damper_n.dot(spring_n);
    if push <= 0.0 {
        0.0
    } else if pull > push {
        push / pull
    } else {
        1.0
    }
}
