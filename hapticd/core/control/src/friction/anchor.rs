//! Friction by motors: the elastic anchor of one wall.

use super::coupling::{tangential, Limits, Motion};
use crate::linear::V3;

/// Speed of a sliding anchor below which it sticks again, m/s (Karnopp's 2…5 mm/s, physics §7).
const RESTICK_M_PER_S: f64 = 0.002;
/// Time over which that speed is averaged, s: several encoder counts at the slowest slip.
const AVERAGE_S: f64 = 0.01;

/// Where the tip is held on one wall.
///
/// The state is the stretch of a spring from the anchor to the tip, not a place: a wall that is
/// moved does not pull. The stretch only ever changes with the tip, or shrinks, so that the spring
/// gives back no more than it took: F·Δx ≤ −ΔS with S = ½k|stretch|², taken at the end of each
/// step (implicit Euler).
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    stretch_m: V3,
    /// Kept while it sticks, so that a spring under load does not change.
    stiffness_n_per_m: f64,
    slide_m_per_s: f64,
    sticks: bool,
}

impl Default for Anchor {
    fn default() -> Self {
        Self {
            stretch_m: V3::zeros(),
            stiffness_n_per_m: 0.0,
            slide_m_per_s: 0.0,
            sticks: true,
        }
    }
}

impl Anchor {
    /// Force on the tip after its step, N.
    pub(super) fn force_n(&mut self, normal: &V3, limits: &Limits, motion: &Motion) -> V3 {
        self.stretch_m = tangential(&(self.stretch_m + motion.step_m), normal);
        self.stiffen(motion.coupling.stiffness_n_per_m);
        let pull_n = self.stiffness_n_per_m * self.stretch_m.norm();
        if pull_n > limits.static_n {
            self.sticks = false;
        }
        let limit_n = if self.sticks {
            limits.static_n
        } else {
            limits.kinetic_n
        };
        self.slide(pull_n, limit_n, motion.period_s);
        let velocity = tangential(&motion.velocity, normal);
        let spring_n = -self.stiffness_n_per_m * self.stretch_m;
        let damper_n = -motion.coupling.damping_n_s_per_m * velocity;
        spring_n + damper_share(&spring_n, &damper_n, limit_n) * damper_n
    }

    /// Whether the anchor stays where it is.
    pub(super) fn sticks(&self) -> bool {
        self.sticks
    }

    /// Energy in the spring, J.
    pub(super) fn energy_j(&self) -> f64 {
        0.5 * self.stiffness_n_per_m * self.stretch_m.norm_squared()
    }

    /// Takes the spring of this pose. A stiffer one starts from the force of the softer one, which
    /// costs energy; a softer one from its stretch, which does too.
    fn stiffen(&mut self, stiffness_n_per_m: f64) {
        if self.sticks && self.stiffness_n_per_m > 0.0 {
            return;
        }
        if stiffness_n_per_m > self.stiffness_n_per_m {
            self.stretch_m *= self.stiffness_n_per_m / stiffness_n_per_m;
        }
        self.stiffness_n_per_m = stiffness_n_per_m;
    }

    /// Lets the anchor follow until the spring pulls with `limit_n`, N, at most.
    fn slide(&mut self, pull_n: f64, limit_n: f64, period_s: f64) {
        let mut way_m = 0.0;
        if pull_n > limit_n {
            way_m = (1.0 - limit_n / pull_n) * self.stretch_m.norm();
            self.stretch_m *= limit_n / pull_n;
        }
        let approach = (period_s / AVERAGE_S).min(1.0);
        self.slide_m_per_s += approach * (way_m / period_s - self.slide_m_per_s);
        if self.slide_m_per_s < RESTICK_M_PER_S {
            self.sticks = true;
        }
    }
}

/// Largest share s, 0…1, of the damper with |spring + s·damper| ≤ `limit_n`; the spring is inside.
fn damper_share(spring_n: &V3, damper_n: &V3, limit_n: f64) -> f64 {
    let a = damper_n.norm_squared();
    if a <= 0.0 {
        return 0.0;
    }
    let half_b = spring_n.dot(damper_n);
    let c = (spring_n.norm_squared() - limit_n * limit_n).min(0.0);
    // The root that is not negative, in the form that does not cancel for half_b > 0.
    let root = (half_b * half_b - a * c).sqrt();
    let share = if half_b > 0.0 {
        -c / (half_b + root)
    } else {
        (root - half_b) / a
    };
    share.min(1.0)
}
