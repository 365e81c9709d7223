//! Which surfaces of the walls face the tip.

use crate::facing::{Facing, Facings};
use crate::linear::V3;
use crate::scene::{Shape, Wall};

/// The proxy of the tip among the walls of one scene.
#[derive(Clone, Debug, Default)]
pub struct Proxy {
    facings: Facings,
    point: V3,
}

impl Proxy {
    /// The surfaces that face the tip, one per wall met.
    #[must_use]
    pub fn facings(&self) -> &Facings {
        &self.facings
    }

    /// The surfaces, their softness to be filled in.
    pub fn facings_mut(&mut self) -> &mut Facings {
        &mut self.facings
    }

    /// Where the tip would rest were every wall rigid, m.
    #[must_use]
    pub fn point(&self) -> V3 {
        self.point
    }

    /// Follows the tip to `x`, m, among `walls`.
    pub fn follow(&mut self, walls: &[Wall], x: &V3) {
        self.point = *x;
        self.facings.clear();
        for (wall, Wall { shape, .. }) in walls.iter().enumerate() {
            if let Shape::Plane { normal, offset_m } = *shape {
                let facing = Facing {
                    wall,
                    normal,
                    offset_m,
                    eta: 1.0,
                };
                if facing.depth_m(x) > 0.0 {
                    self.facings.push(facing);
                }
            }
        }
    }
}
