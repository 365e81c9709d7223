//! What a proxy remembers, and how it outlasts an edit.

use crate::law::exists;
use crate::linear::V3;
use crate::scene::{Wall, MAX_WALLS};
use crate::shape::{is_hollow, Side, Solid};
use crate::sweep::sweep;

/// Where a proxy is.
#[derive(Clone, Copy, Debug)]
pub struct History {
    /// The proxy, m; `None` before the first tick.
    pub point: Option<V3>,
    /// Its side of each wall.
    pub sides: [Side; MAX_WALLS],
}

impl Default for History {
    fn default() -> Self {
        Self {
            point: None,
            sides: [Side::Outside; MAX_WALLS],
        }
    }
}

impl History {
    /// The proxy, m. Where there is none it starts at the tip `x`, on that side of every shell.
    pub fn start(&mut self, walls: &[Wall], x: &V3) -> V3 {
        if let Some(point) = self.point {
            return point;
        }
        for (side, wall) in self.sides.iter_mut().zip(walls) {
            *side = side_of(wall, x);
        }
        self.point = Some(*x);
        *x
    }

    /// What is left of it when the walls `before` give way to `after`: a wall with the same key
    /// keeps the proxy on its side and pushes it along where it moved across it; a new shell is
    /// felt from the side on which the proxy is.
    #[must_use]
    pub fn carried(&self, before: &[Wall], after: &[Wall]) -> Self {
        let Some(mut point) = self.point else {
            return Self::default();
        };
        let mut carried = Self::default();
        let mut known = Known { before, next: 0 };
        for (wall, side) in after.iter().zip(&mut carried.sides) {
            let old = known
                .find(wall.key)
                .map(|old| (&before[old], self.sides[old]));
            *side = match old {
                Some((old, kept)) if exists(&old.law) && is_hollow(&wall.shape) => kept,
                _ => side_of(wall, &point),
            };
            if let Some((old, Side::Outside)) = old {
                if exists(&old.law) && exists(&wall.law) && old.shape != wall.shape {
                    point = sweep(&old.shape, &wall.shape, &point);
                }
            }
        }
        carried.point = Some(point);
        carried
    }
}

/// The side of a wall on which `x`, m, is. A solid has no inside: the tip is pushed out of it.
fn side_of(wall: &Wall, x: &V3) -> Side {
    if is_hollow(&wall.shape) && Solid::from(&wall.shape).distance_m(x) < 0.0 {
        Side::Inside
    } else {
        Side::Outside
    }
}

/// Walls to be found again by key. Scenes mostly keep their order: the search starts behind the
/// wall found last.
struct Known<'a> {
    before: &'a [Wall],
    next: usize,
}

impl Known<'_> {
    fn find(&mut self, key: u64) -> Option<usize> {
        let count = self.before.len();
        let place = (self.next..count)
            .chain(0..self.next.min(count))
            .find(|place| self.before[*place].key == key)?;
        self.next = place + 1;
        Some(place)
    }
}
