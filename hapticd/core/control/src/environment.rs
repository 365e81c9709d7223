//! The quasi-static motion environment: where the walls want the tip (WN §IV, V).

use crate::facing::Facing;
use crate::linear::{M3, V3};

/// Smallest η used. A rigid wall yields by this fraction of the depth, 1 nm at 10 mm, and in
/// exchange duplicates, contradictions and hundreds of walls stay well posed.
const ETA_MIN: f64 = 1e-7;

/// Newton steps at most. Two to four are usual, eleven the most seen; the objective falls with
/// every one, so that an early end is still a point between the tip and the set-point.
const NEWTON_STEPS: usize = 40;

/// Newton step, m, below which the set-point is found: above the rounding among contradicting
/// rigid walls, and 20 µN at 20 N/mm.
const STEP_MIN_M: f64 = 1e-9;

/// Steps after that at most.
const POLISHING_STEPS: usize = 8;

/// Sum of the walls' shares less the pull, m, that is good enough.
const SHARES_M: f64 = 3e-8;

/// Evaluations of the line search at most; two or three are usual.
const SEARCH_STEPS: usize = 30;

/// Share of a step to which the line search is carried.
const SEARCH_ACCURACY: f64 = 1e-6;

/// Where the environment wants the tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SetPoint {
    /// x_Sd, m.
    pub x_sd: V3,
    /// ẋ_Sd, m/s.
    pub xd_sd: V3,
}

/// Set-point of the tip at `x`, m, moving at `xd`, m/s, among `walls` with unit normals.
///
/// One wall gives WN eq. 30, x_Sd = ηx + (1−η)x₀. Several give the proximal point of the
/// Moreau envelope (physics §3.4)
///
/// x_Sd = argmin_z ½|z−x|² + Σ wᵢ/2 max(0, dᵢ − nᵢᵀz)²,  wᵢ = (1−ηᵢ)/ηᵢ,
///
/// whose pull x_Sd − x is the gradient of a potential and never stiffer than one rigid wall.
/// ẋ_Sd = ∂x_Sd/∂x · ẋ. Walls with η ≥ 1 are free space.
#[must_use]
pub fn set_point(walls: &[Facing], x: &V3, xd: &V3) -> SetPoint {
    let proximal = proximal(walls, x);
    SetPoint {
        x_sd: x + proximal.shift,
        xd_sd: proximal.derivative * xd,
    }
}

/// Each wall's share of the pull: Σ shareᵢ nᵢ = x_Sd − x, with shareᵢ = wᵢ max(0, dᵢ − nᵢᵀx_Sd) ≥ 0,
/// m, the multiplier of wall i in the envelope of [`set_point`]. Rigid walls that contradict each
/// other have shares far above their depths, which cancel. Writes the first `walls.len()` of
/// `shares`.
pub fn shares(walls: &[Facing], set_point: &SetPoint, shares: &mut [f64]) {
    for (wall, share) in walls.iter().zip(shares) {
        *share = if wall.eta < 1.0 {
            wall.depth_m(&set_point.x_sd).max(0.0) / variance(wall)
        } else {
            0.0
        };
    }
}

/// 1/w of a wall with η < 1.
fn variance(wall: &Facing) -> f64 {
    let eta = wall.eta.max(ETA_MIN);
    eta / (1.0 - eta)
}

/// Newton's method on the piecewise quadratic objective. Each step minimises over the walls
/// active where it is; it ends when that minimum is where it already is.
fn proximal(walls: &[Facing], x: &V3) -> Proximal {
    let mut shift = V3::zeros();
    let mut view = View::at(walls, x, &shift);
    for _ in 0..NEWTON_STEPS {
        let step = view.minimum.shift - shift;
        if step.norm() <= STEP_MIN_M {
            break;
        }
        let full = View::at(walls, x, &view.minimum.shift);
        if full.objective < view.objective {
            (shift, view) = (view.minimum.shift, full);
        } else {
            shift += step_length(walls, x, &shift, &step) * step;
            view = View::at(walls, x, &shift);
        }
    }
    polished(walls, x, view.minimum)
}

/// The minimum with the walls it is really in. Of rigid walls a depth below [`STEP_MIN_M`] is a
/// share of the pull of up to some centimetres, so that the steps left out decide the shares.
fn polished(walls: &[Facing], x: &V3, found: Proximal) -> Proximal {
    let mut best = (found, excess_m(walls, x, &found.shift));
    let mut last = found;
    for _ in 0..POLISHING_STEPS {
        if best.1 <= SHARES_M {
            break;
        }
        last = View::at(walls, x, &last.shift).minimum;
        let excess = excess_m(walls, x, &last.shift);
        if excess < best.1 {
            best = (last, excess);
        }
    }
    best.0
}

/// By how much the shares of the walls miss the pull, m: the gradient of the objective.
fn excess_m(walls: &[Facing], x: &V3, shift: &V3) -> f64 {
    let pushes = active(walls, x, shift).map(|wall| wall.violation / wall.variance * wall.n);
    (pushes.sum::<V3>() - shift).norm()
}

/// The objective as one point sees it.
struct View {
    /// ½|z−x|² + Σ w/2 violation² at the point.
    objective: f64,
    /// Minimum over the walls active at the point, the others left out.
    minimum: Proximal,
}

impl View {
    fn at(walls: &[Facing], x: &V3, shift: &V3) -> Self {
        let free = Self {
            objective: 0.5 * shift.norm_squared(),
            minimum: Proximal::FREE,
        };
        active(walls, x, shift).fold(free, |mut view, wall| {
            view.objective += 0.5 * wall.violation.powi(2) / wall.variance;
            view.minimum.add(&wall);
            view
        })
    }
}

/// Minimum of the objective over one fixed set of active walls.
#[derive(Clone, Copy)]
struct Proximal {
    /// z − x, m.
    shift: V3,
    /// D = ∂z/∂x = (I + Σ w n nᵀ)⁻¹ over the active walls.
    derivative: M3,
}

impl Proximal {
    const FREE: Self = Self {
        shift: V3::new(0.0, 0.0, 0.0),
        derivative: M3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    };

    /// Adds one wall by a rank-one update: a measurement n·shift = depth of variance 1/w. Stays
    /// accurate where inverting I + Σ w n nᵀ would cancel.
    fn add(&mut self, wall: &Active) {
        let dn = self.derivative * wall.n;
        let gain = dn / (wall.variance + wall.n.dot(&dn));
        self.shift += gain * (wall.depth - wall.n.dot(&self.shift));
        self.derivative -= gain * dn.transpose();
    }
}

/// A wall that contains the point looked at.
struct Active {
    n: V3,
    /// Depth of x, m; not of the point.
    depth: f64,
    /// Depth of the point, m.
    violation: f64,
    /// 1/w.
    variance: f64,
}

fn active<'a>(walls: &'a [Facing], x: &'a V3, shift: &'a V3) -> impl Iterator<Item = Active> + 'a {
    let solid = walls.iter().filter(|wall| wall.eta < 1.0);
    solid.filter_map(move |wall| {
        let n = V3::from(wall.normal);
        let depth = wall.depth_m(x);
        let violation = depth - n.dot(shift);
        (violation > 0.0).then(|| Active {
            n,
            depth,
            violation,
            variance: variance(wall),
        })
    })
}

/// Share of a step that reaches the minimum along it, by Newton's method within a bracket. Only
/// needed where the full step would not lower the objective; it rules out cycles of active sets.
fn step_length(walls: &[Facing], x: &V3, shift: &V3, step: &V3) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = 1.0;
    for _ in 0..SEARCH_STEPS {
        let (slope, curvature) = line(walls, x, &(shift + t * step), step);
        if slope > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let newton = t - slope / curvature;
        let next = if (low..=high).contains(&newton) {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - t).abs() <= SEARCH_ACCURACY {
            return next;
        }
        t = next;
    }
    low
}

/// First and second derivative of the objective along `step`.
fn line(walls: &[Facing], x: &V3, shift: &V3, step: &V3) -> (f64, f64) {
    let free = (shift.dot(step), step.norm_squared());
    active(walls, x, shift).fold(free, |(slope, curvature), wall| {
        let rate = wall.n.dot(step);
        (
            slope - wall.violation * rate / wall.variance,
            curvature + rate * rate / wall.variance,
        )
    })
}
