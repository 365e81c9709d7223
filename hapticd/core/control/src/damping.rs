//! The dampers of all walls as one force: together never harder than the hardest of them.

use crate::environment::{set_point, SetPoint};
use crate::facing::Facing;
use crate::linear::{M3, V3};

/// Smallest share of a speed that a damper lets pass; see `environment::ETA_MIN`.
const PASS_MIN: f64 = 1e-7;

/// Σ wᵢ nᵢ nᵀ of dampers that act inwards and outwards, as the velocity they let pass.
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// The hardest damper, N·s/m.
    reference_n_s_per_m: f64,
    /// Tip velocity let pass, u = (I + Σ w n nᵀ)⁻¹ ẋ.
    pass: M3,
}

impl Linear {
    /// No damper yet; none of those to come is harder than `reference_n_s_per_m`.
    #[must_use]
    pub fn new(reference_n_s_per_m: f64) -> Self {
        Self {
            reference_n_s_per_m,
            pass: M3::identity(),
        }
    }

    /// Adds a damper along `normal` by a rank-one update.
    pub fn add(&mut self, normal: &V3, damping_n_s_per_m: f64) {
        if let Some(w) = self.weight(damping_n_s_per_m) {
            let un = self.pass * normal;
            self.pass -= un * un.transpose() / (w.recip() + normal.dot(&un));
        }
    }

    /// Force on a tip moving at `xd`, N. F·ẋ ≤ 0.
    #[must_use]
    pub fn force_n(&self, xd: &V3) -> V3 {
        self.reference_n_s_per_m * (self.pass * xd - xd)
    }

    /// Part of the force that the damper along `normal` gives, N, signed along it.
    #[must_use]
    pub fn part_n(&self, normal: &V3, damping_n_s_per_m: f64, xd: &V3) -> f64 {
        let w = self.weight(damping_n_s_per_m).unwrap_or(0.0);
        -self.reference_n_s_per_m * w * normal.dot(&(self.pass * xd))
    }

    fn weight(&self, damping_n_s_per_m: f64) -> Option<f64> {
        (damping_n_s_per_m > 0.0)
            .then(|| weight(1.0 - damping_n_s_per_m / self.reference_n_s_per_m))
    }
}

/// w = (1−η)/η of a wall that lets the share η pass.
fn weight(eta: f64) -> f64 {
    let pass = eta.max(PASS_MIN);
    (1.0 - pass) / pass
}

/// A surface as a damper against penetration alone: it holds velocities, m/s, instead of
/// positions, and the velocity it lets pass is the Moreau envelope of all of them.
#[must_use]
pub fn against_penetration(facing: &Facing, beta: f64) -> Facing {
    Facing {
        offset_m: 0.0,
        eta: 1.0 - beta,
        ..*facing
    }
}

/// Velocity that one-sided dampers let pass of `xd`, m/s, as a set-point: none of them answers
/// motion outwards.
#[must_use]
pub fn passed(dampers: &[Facing], xd: &V3) -> SetPoint {
    set_point(dampers, xd, &V3::zeros())
}
