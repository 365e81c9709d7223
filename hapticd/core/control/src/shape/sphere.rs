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

    /// Whether `p`, m, is farther than `reach_m` from it.
    #[must_use]
    pub fn is_beyond(&self, p: &V3, reach_m: f64) -> bool {
        (p - self.center_m).norm_squared() > (self.radius_m + reach_m).powi(2)
    }

    /// Largest n·y of its points y, m.
    #[must_use]
    pub fn extent_m(&self, normal: &V3) -> f64 {
        normal.dot(&self.center_m) + self.radius_m
    }
}
