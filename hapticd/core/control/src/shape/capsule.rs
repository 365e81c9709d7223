//! Everything within a radius of a segment.

use super::Ball;
use crate::linear::V3;

/// Solid within a radius of a segment.
#[derive(Clone, Copy, Debug)]
pub struct Capsule {
    /// One end of the segment, m.
    pub from_m: V3,
    /// The other end, m.
    pub to_m: V3,
    /// Radius, m.
    pub radius_m: f64,
}

impl Capsule {
    /// Direction from the segment to `p`, m; perpendicular to it where that is none.
    #[must_use]
    pub fn outward(&self, p: &V3) -> V3 {
        (p - self.closest(p))
            .try_normalize(0.0)
            .unwrap_or_else(|| self.sideways())
    }

    /// The point of the segment closest to `p`, m.
    fn closest(&self, p: &V3) -> V3 {
        let along = self.to_m - self.from_m;
        let length_squared = along.norm_squared();
        if length_squared == 0.0 {
            return self.from_m;
        }
        let share = (p - self.from_m).dot(&along) / length_squared;
        self.from_m + share.clamp(0.0, 1.0) * along
    }

    /// A direction across the segment, within the plane of a two-joint device.
    fn sideways(&self) -> V3 {
        let along = self.to_m - self.from_m;
        V3::z()
            .cross(&along)
            .try_normalize(0.0)
            .unwrap_or_else(V3::x)
    }

    /// Largest n·y of its points y, m.
    #[must_use]
    pub fn extent_m(&self, normal: &V3) -> f64 {
        normal.dot(&self.from_m).max(normal.dot(&self.to_m)) + self.radius_m
    }

    /// A ball around it.
    #[must_use]
    pub fn ball(&self) -> Ball {
        Ball {
            center_m: 0.5 * (self.from_m + self.to_m),
            radius_m: 0.5 * (self.to_m - self.from_m).norm() + self.radius_m,
        }
    }
}
