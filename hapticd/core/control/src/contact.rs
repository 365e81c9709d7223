//! Which walls the tip is in.

use crate::facing::Facing;
use crate::linear::V3;

/// What the tip touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Walls the tip is in; walls with η = 1 do not exist.
    pub count: usize,
    /// Index of the deepest; [`usize::MAX`] when free.
    pub wall: usize,
    /// Depth in the deepest, m.
    pub depth_m: f64,
    /// Normal of the deepest, zero when free.
    pub normal: V3,
}

impl Contact {
    /// No wall touched.
    pub const FREE: Self = Self {
        count: 0,
        wall: usize::MAX,
        depth_m: 0.0,
        normal: V3::new(0.0, 0.0, 0.0),
    };
}

/// The walls that contain the tip `x`, m.
#[must_use]
pub fn contact(walls: &[Facing], x: &V3) -> Contact {
    let mut found = Contact::FREE;
    for wall in walls.iter().filter(|wall| wall.eta < 1.0) {
        let depth_m = wall.depth_m(x);
        if depth_m > 0.0 {
            found.count += 1;
        }
        if depth_m > found.depth_m {
            found.wall = wall.wall;
            found.depth_m = depth_m;
            found.normal = wall.normal.into();
        }
    }
    found
}
