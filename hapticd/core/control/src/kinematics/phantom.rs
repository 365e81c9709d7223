//! PHANTOM: base rotation and a parallelogram, q2 and q3 both against the base
//! (physics §1; mahilab/Phantom).

use crate::linear::{M3, V3};
use std::f64::consts::FRAC_PI_2;

/// Upper link and forearm, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phantom {
    pub l1: f64,
    pub l2: f64,
}

impl Phantom {
    /// Distance of the tip from the base axis, m; negative behind it.
    fn radius(&self, q: &V3) -> f64 {
        self.l1 * q.y.cos() + self.l2 * q.z.sin()
    }

    fn height(&self, q: &V3) -> f64 {
        self.l1 * q.y.sin() - self.l2 * q.z.cos()
    }

    pub fn forward(&self, q: &V3) -> V3 {
        let r = self.radius(q);
        V3::new(r * q.x.cos(), r * q.x.sin(), self.height(q))
    }

    pub fn jacobian(&self, q: &V3) -> M3 {
        let r = self.radius(q);
        let (s1, c1) = q.x.sin_cos();
        let (l1_s2, l1_c2) = (self.l1 * q.y.sin(), self.l1 * q.y.cos());
        let (l2_s3, l2_c3) = (self.l2 * q.z.sin(), self.l2 * q.z.cos());
        M3::new(
            -s1 * r,
            -l1_s2 * c1,
            l2_c3 * c1,
            c1 * r,
            -l1_s2 * s1,
            l2_c3 * s1,
            0.0,
            l1_c2,
            l2_s3,
        )
    }

    /// The branch in front of the base axis with |q3 − q2| < 90°.
    pub fn inverse(&self, x: &V3) -> Option<V3> {
        let radius = x.x.hypot(x.y);
        let d = radius.hypot(x.z);
        let (l1, l2) = (self.l1, self.l2);
        let shoulder = super::acos_within((l1 * l1 + d * d - l2 * l2) / (2.0 * l1 * d))?;
        let elbow = super::acos_within((l1 * l1 + l2 * l2 - d * d) / (2.0 * l1 * l2))?;
        let q2 = shoulder + x.z.atan2(radius);
        (radius > 0.0).then(|| V3::new(x.y.atan2(x.x), q2, q2 + elbow - FRAC_PI_2))
    }

    /// Smaller of two sines: of the angle between the links, and of the angle between the tip
    /// and the base axis. det J = r l1 l2 cos(q3 − q2).
    pub fn singularity_margin(&self, q: &V3) -> f64 {
        let r = self.radius(q);
        let d = r.hypot(self.height(q)).max(f64::MIN_POSITIVE);
        (q.z - q.y).cos().min(r / d).max(0.0)
    }
}
