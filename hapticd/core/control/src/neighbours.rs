//! The walls near the tip, so that the cost of a tick does not grow with those that are far.

use crate::law::exists;
use crate::linear::V3;
use crate::scene::{Wall, MAX_WALLS};
use crate::shape::{is_hollow, Ball, Solid};

/// How much farther the list reaches than it must, m: it lasts until the tip has moved so far, 30
/// ticks at 0.3 m/s.
const SKIN_M: f64 = 0.01;

/// A Verlet list: the walls whose surface comes within `reach_m` of `center_m`.
///
/// It serves a ball as long as that lies within. Rebuilding compares each wall's bounding ball,
/// and where that is near the wall itself: linear in the walls, but rare and cheap.
#[derive(Clone, Debug)]
pub struct Neighbours {
    solids: [Solid; MAX_WALLS],
    balls: [Ball; MAX_WALLS],
    center_m: V3,
    reach_m: f64,
    count: usize,
    walls: [u16; MAX_WALLS],
}

impl Default for Neighbours {
    fn default() -> Self {
        let nowhere = Ball {
            center_m: V3::zeros(),
            radius_m: 0.0,
        };
        Self {
            solids: [Solid::default(); MAX_WALLS],
            balls: [nowhere; MAX_WALLS],
            center_m: V3::zeros(),
            reach_m: f64::NEG_INFINITY,
            count: 0,
            walls: [0; MAX_WALLS],
        }
    }
}

impl Neighbours {
    /// Takes up other walls.
    pub fn adopt(&mut self, walls: &[Wall]) {
        let slots = self.solids.iter_mut().zip(&mut self.balls);
        for ((solid, ball), wall) in slots.zip(walls) {
            *solid = Solid::from(&wall.shape);
            *ball = solid.ball();
        }
        self.reach_m = f64::NEG_INFINITY;
    }

    /// Makes the list cover all within `radius_m` of `x`, m.
    pub fn cover(&mut self, walls: &[Wall], x: &V3, radius_m: f64) {
        if (x - self.center_m).norm() + radius_m <= self.reach_m {
            return;
        }
        self.center_m = *x;
        self.reach_m = radius_m + SKIN_M;
        self.count = 0;
        for (i, (wall, ball)) in walls.iter().zip(&self.balls).enumerate() {
            let reach_m = ball.radius_m + self.reach_m;
            let near = (x - ball.center_m).norm_squared() <= reach_m * reach_m;
            let surface_m = |solid| surface_m(solid, is_hollow(&wall.shape), x);
            if near && exists(&wall.law) && surface_m(&self.solids[i]) <= self.reach_m {
                self.walls[self.count] = i as u16;
                self.count += 1;
            }
        }
    }

    /// The walls in their order: index and shape.
    pub fn walls(&self) -> impl Iterator<Item = (usize, &Solid)> {
        let indices = self.walls[..self.count].iter();
        indices.map(|wall| (usize::from(*wall), &self.solids[usize::from(*wall)]))
    }
}

/// Distance of `x`, m, from what of a wall can be met from there: its surface, or the solid.
fn surface_m(solid: &Solid, hollow: bool, x: &V3) -> f64 {
    let distance_m = solid.distance_m(x);
    if hollow {
        distance_m.abs()
    } else {
        distance_m
    }
}
