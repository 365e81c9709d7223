//! A cuboid.

use crate::linear::V3;

/// Distance, m, below which a point lies on the surface: the direction to it would be rounding.
const ON_SURFACE_M: f64 = 1e-12;

/// Solid within a half edge of its centre along each axis.
#[derive(Clone, Copy, Debug)]
pub struct Cuboid {
    /// Centre, m.
    pub center_m: V3,
    /// Unit vectors of its edges, perpendicular to each other.
    pub axes: [V3; 3],
    /// Half of each edge, m.
    pub half_m: V3,
}

impl Cuboid {
    /// Direction from the closest point of the solid to `p`, m; of the nearest face inside.
    #[must_use]
    pub fn outward(&self, p: &V3) -> V3 {
        let local = self.local(p);
        let beyond = self.beyond(&local);
        let distance_m = beyond.norm();
        if distance_m > ON_SURFACE_M {
            self.to_base(&(beyond / distance_m))
        } else {
            self.nearest_face(&local)
        }
    }

    /// Whether `p`, m, is farther than `reach_m` from it.
    #[must_use]
    pub fn is_beyond(&self, p: &V3, reach_m: f64) -> bool {
        self.beyond(&self.local(p)).norm_squared() > reach_m * reach_m
    }

    /// The way to a point from the closest one of the solid, along the edges, m.
    fn beyond(&self, local: &V3) -> V3 {
        local.zip_map(&self.half_m, |l, half| l - l.max(-half).min(half))
    }

    fn nearest_face(&self, local: &V3) -> V3 {
        let nearest = (local.abs() - self.half_m).imax();
        self.axes[nearest] * 1.0_f64.copysign(local[nearest])
    }

    /// Largest n·y of its points y, m.
    #[must_use]
    pub fn extent_m(&self, normal: &V3) -> f64 {
        let across = V3::from(self.axes.map(|axis| axis.dot(normal).abs()));
        normal.dot(&self.center_m) + self.half_m.dot(&across)
    }

    fn local(&self, p: &V3) -> V3 {
        let from_center = p - self.center_m;
        self.axes.map(|axis| axis.dot(&from_center)).into()
    }

    /// A direction given along the edges, in the base frame.
    #[must_use]
    pub fn to_base(&self, local: &V3) -> V3 {
        local.x * self.axes[0] + local.y * self.axes[1] + local.z * self.axes[2]
    }
}
