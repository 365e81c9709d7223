//! A ball.

use crate::linear::V3;

/// Solid within a radius of a point.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre, m.
    pub center_m: V3,
    /// Radius, m.
    pub radius_m: f64,
}

impl Sphere {
    /// Direction from the centre to `p`, m; along x where that is none.
    #[must_use]
    pub fn outward(&self, p: &V3) -> V3 {
        (p - self.center_m).try_normalize(0.0).unwrap_or_else(V3::x)
    }

    /// Largest n·y of its points y, m.
    #[must_use]
    pub fn extent_m(&self, normal: &V3) -> f64 {
        normal.dot(&self.center_m) + self.radius_m
    }
}
