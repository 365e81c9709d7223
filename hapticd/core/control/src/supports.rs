//! Free space around the proxy: the half-spaces that leave the walls out.

use crate::linear::V3;
use crate::scene::MAX_WALLS;
use crate::shape::Support;

/// Most half-spaces. Four for each wall; a shell has more only where it is smaller than a step.
const MAX_SUPPORTS: usize = 4 * MAX_WALLS;

/// Distance, m, that the proxy keeps from every wall: far below any encoder, far above rounding.
pub const CLEARANCE_M: f64 = 1e-9;

/// Least distance, m, at which a point counts as free.
pub const FREE_M: f64 = 0.5 * CLEARANCE_M;

/// How far a half-space may be missed, m.
const MISS_M: f64 = 1e-12;

/// Exchanges of active half-spaces at most. The distance grows with every one, so that none comes
/// back; three or four are usual.
const PIVOTS: usize = 64;

/// Squared sine between two normals below which they are parallel.
const PARALLEL: f64 = 1e-14;

/// Half-spaces around one point, each with the wall it leaves out.
#[derive(Clone, Debug)]
pub struct Supports {
    count: usize,
    planes: [Support; MAX_SUPPORTS],
    walls: [usize; MAX_SUPPORTS],
    everywhere: [bool; MAX_SUPPORTS],
}

impl Default for Supports {
    fn default() -> Self {
        Self {
            count: 0,
            planes: [Support::default(); MAX_SUPPORTS],
            walls: [0; MAX_SUPPORTS],
            everywhere: [false; MAX_SUPPORTS],
        }
    }
}

impl Supports {
    /// Forgets them all.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds one of wall `wall`; `everywhere` where it contains all space that the wall leaves
    /// free, as of a plane or a cavity. Those past the capacity are left out.
    pub fn push(&mut self, wall: usize, support: Support, everywhere: bool) {
        if self.count < MAX_SUPPORTS {
            self.planes[self.count] = support;
            self.walls[self.count] = wall;
            self.everywhere[self.count] = everywhere;
            self.count += 1;
        }
    }

    fn planes(&self) -> &[Support] {
        &self.planes[..self.count]
    }

    /// Each wall with its half-spaces.
    pub fn by_wall(&self) -> impl Iterator<Item = (usize, &Support)> {
        self.walls.iter().copied().zip(self.planes())
    }

    /// The half-space that `p`, m, is farthest from being within, and by how much, m.
    #[must_use]
    pub fn worst(&self, p: &V3) -> Option<(&Support, f64)> {
        worst(self.planes().iter(), p)
    }

    /// The point within all half-spaces closest to `x`, m, with its clearance.
    #[must_use]
    pub fn nearest(&self, x: &V3) -> V3 {
        match nearest(x, || self.planes().iter()) {
            Ok(point) | Err(point) => point,
        }
    }

    /// Whether the walls leave no free space at all, searched from `x`, m: known without a try at
    /// the ways out of them, which all would fail.
    #[must_use]
    pub fn is_shut(&self, x: &V3) -> bool {
        let everywhere = || {
            let all = self.planes().iter().zip(&self.everywhere);
            all.filter_map(|(plane, everywhere)| everywhere.then_some(plane))
        };
        nearest(x, everywhere).is_err()
    }

    /// The share of the way from `p` to `q`, m, that stays free. Half-spaces that `p` is not in
    /// are only not left any further.
    #[must_use]
    pub fn reach(&self, p: &V3, q: &V3) -> f64 {
        let mut share: f64 = 1.0;
        for plane in self.planes() {
            let (here_m, there_m) = (plane.gap_m(p), plane.gap_m(q));
            if there_m < FREE_M.min(here_m) {
                share = share.min(((here_m - FREE_M) / (here_m - there_m)).max(0.0));
            }
        }
        share
    }
}

/// The half-space that `p`, m, is farthest from being within, and by how much, m.
fn worst<'a>(planes: impl Iterator<Item = &'a Support>, p: &V3) -> Option<(&'a Support, f64)> {
    let mut worst = None;
    let mut worst_m = MISS_M;
    for plane in planes {
        let short_m = short_m(plane, p);
        if short_m > worst_m {
            (worst, worst_m) = (Some(plane), short_m);
        }
    }
    worst.map(|plane| (plane, worst_m))
}

/// The point within all half-spaces closest to `x`, m; as an error how far it came where four or
/// fewer of them contradict each other. The dual simplex method: of the half-spaces not met the
/// worst becomes active, and those it makes idle leave.
fn nearest<'a, I: Iterator<Item = &'a Support>>(x: &V3, planes: impl Fn() -> I) -> Result<V3, V3> {
    let mut vertex = Vertex::free(x);
    for _ in 0..PIVOTS {
        let Some((plane, _)) = worst(planes(), &vertex.point) else {
            break;
        };
        vertex = vertex.pivot(x, plane).ok_or(vertex.point)?;
    }
    Ok(vertex.point)
}

/// The closest point to x of at most three half-spaces, all of them active.
struct Vertex {
    point: V3,
    count: usize,
    active: [Support; 3],
}

impl Vertex {
    fn free(x: &V3) -> Self {
        Self {
            point: *x,
            count: 0,
            active: [Support::default(); 3],
        }
    }

    /// The vertex of these half-spaces and one more that this vertex is not in: on its plane, then
    /// on a line of it, then in a corner, as the others ask for (Seidel 1991). `None` where they
    /// contradict each other.
    fn pivot(&self, x: &V3, plane: &Support) -> Option<Self> {
        let mut next = Self::of(x + short_m(plane, x) * plane.normal, &[*plane]);
        let others = &self.active[..self.count];
        for (i, other) in others.iter().enumerate() {
            let missed_m = short_m(other, &next.point);
            if missed_m > MISS_M {
                match Edge::of(x, plane, other) {
                    Some(edge) => next = edge.nearest(&others[..i])?,
                    None if missed_m > FREE_M => return None,
                    None => {}
                }
            }
        }
        Some(next)
    }

    fn of(point: V3, planes: &[Support]) -> Self {
        let mut active = [Support::default(); 3];
        active[..planes.len()].copy_from_slice(planes);
        Self {
            point,
            count: planes.len(),
            active,
        }
    }
}

/// Where the planes of two half-spaces meet.
struct Edge {
    /// Its point closest to x, m.
    point: V3,
    along: V3,
    planes: [Support; 2],
}

impl Edge {
    /// `None` where the planes are parallel.
    fn of(x: &V3, a: &Support, b: &Support) -> Option<Self> {
        let cosine = a.normal.dot(&b.normal);
        let along = a.normal.cross(&b.normal);
        let sine_squared = along.norm_squared();
        if sine_squared < PARALLEL {
            return None;
        }
        let (short_a, short_b) = (short_m(a, x), short_m(b, x));
        let push_a = (short_a - cosine * short_b) / sine_squared;
        let push_b = (short_b - cosine * short_a) / sine_squared;
        Some(Self {
            point: x + push_a * a.normal + push_b * b.normal,
            along: along / sine_squared.sqrt(),
            planes: [*a, *b],
        })
    }

    /// Its point closest to x within the `others`; `None` where they contradict.
    fn nearest(&self, others: &[Support]) -> Option<Vertex> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut lowest, mut highest) = (None, None);
        for other in others {
            let rate = other.normal.dot(&self.along);
            let missed_m = short_m(other, &self.point);
            if rate * rate < PARALLEL {
                if missed_m > FREE_M {
                    return None;
                }
                continue;
            }
            let at = missed_m / rate;
            if rate > 0.0 && at > low {
                (low, lowest) = (at, Some(other));
            } else if rate < 0.0 && at < high {
                (high, highest) = (at, Some(other));
            }
        }
        let (at, corner) = match (low > 0.0, high < 0.0) {
            (true, true) => (0.5 * (low + high), lowest),
            (true, false) => (low.min(high), lowest),
            (false, true) => (high.max(low), highest),
            (false, false) => (0.0, None),
        };
        let point = self.point + at * self.along;
        let [a, b] = self.planes;
        match corner {
            // Between walls that touch each other there is room up to rounding.
            Some(c) if short_m(c, &point) > FREE_M => None,
            Some(c) => Some(Vertex::of(point, &[a, b, *c])),
            None => Some(Vertex::of(point, &[a, b])),
        }
    }
}

/// What `p` lacks to its clearance, m.
fn short_m(plane: &Support, p: &V3) -> f64 {
    CLEARANCE_M - plane.gap_m(p)
}
