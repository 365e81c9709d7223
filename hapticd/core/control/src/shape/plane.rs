//! A half-space.

use crate::linear::V3;

/// Solid where n·y < `offset_m`.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Unit normal into free space.
    pub normal: V3,
    /// n·p of a point p of the plane, m.
    pub offset_m: f64,
}
