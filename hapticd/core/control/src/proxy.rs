//! The proxy of the tip: where it would rest were every wall rigid.

use crate::facing::{Facing, Facings};
use crate::history::History;
use crate::linear::V3;
use crate::neighbours::Neighbours;
use crate::scene::Wall;
use crate::shape::{Side, Solid, Support};
use crate::supports::{Supports, FREE_M};

/// Rounds of a tick at most. A flat wall takes two; a round one brings the proxy nearer to its
/// place by the ratio of depth to radius each, and the next tick goes on.
const ROUNDS: usize = 16;

/// Move, m, below which the proxy rests.
const REST_M: f64 = 1e-10;

/// Most pushes out of a wall in one tick.
const PUSHES: usize = 8;

/// How much farther it looks around where it was shut in, m.
const SHUT_M: f64 = 0.01;

/// Cuts of a round cavity in one round at most. Each leaves a quarter of the error of the one
/// before, or less.
const CUTS: usize = 32;

/// Halvings of a step that still leaves a round cavity after all cuts.
const HALVINGS: i32 = 20;

/// Owner of a half-space that is no tangent plane at the proxy.
const NOBODY: usize = usize::MAX;

/// The proxy of the tip among the walls of one scene.
///
/// It stays in free space. In every round each wall near by is replaced by a half-space that
/// contains no point of it: the one that touches it where it is closest to the proxy. The proxy
/// is within all of them, and so is the straight way to the point of their intersection closest
/// to the tip: it goes there, and can cross no wall, however thin and however fast the tip. Where
/// it rests it is the locally closest free point, and the half-spaces are the tangent planes
/// (Zilles and Salisbury 1995, without their search for the surface hit first).
#[derive(Clone, Debug, Default)]
pub struct Proxy {
    facings: Facings,
    history: History,
    near: Neighbours,
    /// Whether the walls left it no free space in the last tick.
    shut_in: bool,
}

impl Proxy {
    /// The surfaces that face the tip.
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
        self.history.point.unwrap_or_default()
    }

    /// What outlasts an edit.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Starts among `walls` with what is known of them.
    pub fn adopt(&mut self, walls: &[Wall], history: History) {
        self.facings.clear();
        self.near.adopt(walls);
        self.history = history;
        self.shut_in = false;
    }

    /// Forgets where the tip was: it may have been taken through walls unseen.
    pub fn reset(&mut self) {
        self.history.point = None;
    }

    /// Follows the tip to `x`, m, among `walls`; `around` is room to work in. A tip that is
    /// nowhere faces nothing and leaves the proxy where it was.
    pub fn follow(&mut self, walls: &[Wall], x: &V3, around: &mut Supports) {
        self.facings.clear();
        if !x.iter().all(|value| value.is_finite()) {
            return;
        }
        let from = self.history.start(walls, x);
        let from = if self.shut_in { *x } else { from };
        let p = self.rest(walls, x, from, around);
        self.history.point = Some(p);
        // A soft set-point is no further from the tip than the proxy: in a sharp corner one wall
        // pushes it into the next, that the tip itself is not in.
        let span_m = if self.shut_in { SHUT_M } else { (p - x).norm() };
        for (wall, support) in around.by_wall() {
            if wall != NOBODY && support.gap_m(x) < span_m {
                self.facings.push(Facing {
                    wall,
                    normal: support.normal.into(),
                    offset_m: support.offset_m,
                    eta: 1.0,
                });
            }
        }
    }

    /// Where the proxy comes to rest, with the half-spaces there `around` it.
    fn rest(&mut self, walls: &[Wall], x: &V3, from: V3, around: &mut Supports) -> V3 {
        let mut p = from;
        let mut pushes = 0;
        for _ in 0..ROUNDS {
            self.look(walls, &p, x, around);
            let next = match around.worst(&p) {
                Some((_, short_m)) if short_m > FREE_M => {
                    pushes += 1;
                    if pushes > PUSHES || around.is_shut(x) {
                        // No free space where walls have closed around it: it starts anew at the tip.
                        let looked = self.shut_in && p == *x;
                        self.shut_in = true;
                        if looked {
                            return p;
                        }
                        p = *x;
                        break;
                    }
                    around.nearest(&p)
                }
                _ => {
                    self.shut_in = false;
                    self.step(&p, x, around)
                }
            };
            let moved_m = (next - p).norm();
            p = next;
            if moved_m <= REST_M || p == *x {
                return p;
            }
        }
        self.look(walls, &p, x, around);
        p
    }

    /// One step towards `x` through the free space `around`.
    fn step(&self, p: &V3, x: &V3, around: &mut Supports) -> V3 {
        let mut q = around.nearest(x);
        for _ in 0..CUTS {
            if !self.cut(&q, around) {
                return p + around.reach(p, &q) * (q - p);
            }
            q = around.nearest(x);
        }
        (0..HALVINGS)
            .map(|halving| p + 0.5_f64.powi(halving) * (q - p))
            .find(|shorter| !self.cut(shorter, around))
            .unwrap_or(*p)
    }

    /// Fences the round cavities in where `q` is beyond their surface.
    fn cut(&self, q: &V3, around: &mut Supports) -> bool {
        let mut beyond = false;
        for (wall, solid) in self.near.walls() {
            if self.is_cavity(wall) && solid.is_round() && solid.distance_m(q) > -FREE_M {
                solid.enclose(q, |support| around.push(NOBODY, support, true));
                beyond = true;
            }
        }
        beyond
    }

    fn is_cavity(&self, wall: usize) -> bool {
        self.history.sides[wall] == Side::Inside
    }

    /// Looks around from `p`: the half-spaces that can matter on the way to `x`. The way stays
    /// within |x − p| of `x`.
    fn look(&mut self, walls: &[Wall], p: &V3, x: &V3, around: &mut Supports) {
        let span_m = (x - p).norm();
        self.near.cover(walls, x, span_m);
        around.clear();
        let mut reach_m = 2.0 * span_m + FREE_M;
        if self.shut_in {
            // What shut it in is looked for at once, also where the tip is not in it.
            reach_m += SHUT_M;
        }
        for (wall, solid) in self.near.walls() {
            let mut keep = |owner: usize, support: Support, everywhere: bool| {
                if support.gap_m(p) <= reach_m {
                    around.push(owner, support, everywhere);
                }
            };
            if self.is_cavity(wall) {
                solid.enclose(p, |support| keep(wall, support, true));
                if solid.is_round() {
                    solid.enclose(x, |support| keep(NOBODY, support, true));
                }
            } else if !solid.is_beyond(p, reach_m) {
                let everywhere = matches!(solid, Solid::Plane(_));
                keep(wall, solid.support(p), everywhere);
            }
        }
    }
}
