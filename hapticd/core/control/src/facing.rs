//! The surfaces that face the tip: what is left of the walls' shapes in one tick.

use crate::io::Axes;
use crate::linear::V3;
use crate::scene::MAX_WALLS;

/// Most planes of one scene: a corner inside a hollow box has three.
pub const MAX_FACINGS: usize = 3 * MAX_WALLS;

/// A tangent plane of one wall where the tip meets it. The planes of one wall follow each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facing {
    /// Index of the wall in its scene.
    pub wall: usize,
    /// Unit normal into free space.
    pub normal: Axes,
    /// n·p of a point p of the plane, m.
    pub offset_m: f64,
    /// Share of the tip's penetration that its wall lets pass: 0 rigid … 1 free (WN eq. 30).
    pub eta: f64,
}

impl Facing {
    /// Depth of `x`, m, behind the plane: positive inside.
    #[must_use]
    pub fn depth_m(&self, x: &V3) -> f64 {
        self.offset_m - V3::from(self.normal).dot(x)
    }
}

/// The planes of one scene in one tick.
#[derive(Clone, Debug)]
pub struct Facings {
    count: usize,
    planes: [Facing; MAX_FACINGS],
}

impl Default for Facings {
    fn default() -> Self {
        Self {
            count: 0,
            planes: [Facing::default(); MAX_FACINGS],
        }
    }
}

impl Facings {
    /// The planes.
    #[must_use]
    pub fn as_slice(&self) -> &[Facing] {
        &self.planes[..self.count]
    }

    /// The planes, to be changed.
    pub fn as_mut_slice(&mut self) -> &mut [Facing] {
        &mut self.planes[..self.count]
    }

    /// Forgets them all.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds one; a scene has at most [`MAX_FACINGS`].
    pub fn push(&mut self, facing: Facing) {
        if let Some(slot) = self.planes.get_mut(self.count) {
            *slot = facing;
            self.count += 1;
        }
    }
}
