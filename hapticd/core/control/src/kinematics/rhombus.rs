//! HHD: a five-bar with coaxial motors and equal links, which is a rhombus (KS §2.1, physics §4.1).

use crate::linear::{M3, V3};

/// Every link, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rhombus {
    pub l: f64,
}

impl Rhombus {
    pub fn forward(&self, q: &V3) -> V3 {
        self.l * V3::new(q.x.cos() + q.y.cos(), q.x.sin() + q.y.sin(), 0.0)
    }

    pub fn jacobian(&self, q: &V3) -> M3 {
        let (s1, c1) = q.x.sin_cos();
        let (s2, c2) = q.y.sin_cos();
        self.l * M3::new(-s1, -s2, 0.0, c1, c2, 0.0, 0.0, 0.0, 0.0)
    }

    /// The branch 0 ≤ θ2 − θ1 < 180°; the third coordinate of `x` is ignored.
    pub fn inverse(&self, x: &V3) -> Option<V3> {
        let r = x.x.hypot(x.y);
        let half_opening = super::acos_within(r / (2.0 * self.l))?;
        let phi = x.y.atan2(x.x);
        (r > 0.0).then(|| V3::new(phi - half_opening, phi + half_opening, 0.0))
    }

    /// sin δ, δ = θ2 − θ1. det J = l² sin δ.
    pub fn singularity_margin(&self, q: &V3) -> f64 {
        (q.y - q.x).sin().max(0.0)
    }
}
