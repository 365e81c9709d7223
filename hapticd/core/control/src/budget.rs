//! The I²t budget: peak load for a short time, continuous load for ever.

use crate::io::Axes;
use crate::linear::V3;

/// Used budget at which the limit starts to fold back from peak to continuous.
const FOLD_START: f64 = 0.8;
/// Used budget past which the motor does not obey the folded limit: a fault.
const OVERDRAWN: f64 = 1.2;

/// Ratings of the motors, in whatever unit loads come: A or N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rating {
    /// Peak load.
    pub peak: Axes,
    /// Load that may last.
    pub continuous: Axes,
    /// Time the peak may last from cold, s.
    pub peak_time_s: f64,
}

/// First-order image of the heating by load², scaled so that 1 is what continuous load rests at.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    rating: Rating,
    approach: V3,
    used: V3,
}

impl Budget {
    /// A cold budget, stepped every `period_s`. Its time constant makes peak load last exactly
    /// `peak_time_s` from cold: 1 = (peak/continuous)² (1 − e^(−t/τ)).
    #[must_use]
    pub fn new(rating: Rating, period_s: f64) -> Self {
        let approach = V3::from_fn(|i, _| {
            let relief = -(-(rating.continuous[i] / rating.peak[i]).powi(2)).ln_1p();
            let time_s = rating.peak_time_s / relief;
            -(-period_s / time_s).exp_m1()
        });
        Self {
            rating,
            approach: approach.map(|value| if value.is_finite() { value } else { 0.0 }),
            used: V3::zeros(),
        }
    }

    /// One period under `load`.
    pub fn step(&mut self, load: &V3) {
        for i in 0..3 {
            if self.rating.continuous[i] > 0.0 {
                let heating = (load[i] / self.rating.continuous[i]).powi(2);
                self.used[i] += self.approach[i] * (heating - self.used[i]);
            }
        }
    }

    /// Budget used, 0 to 1.
    #[must_use]
    pub fn used(&self) -> V3 {
        self.used
    }

    /// Largest load allowed now: peak, folded linearly to continuous as the budget runs out.
    #[must_use]
    pub fn limit(&self) -> V3 {
        V3::from_fn(|i, _| {
            let (peak, continuous) = (self.rating.peak[i], self.rating.continuous[i]);
            peak - fold(self.used[i]) * (peak - continuous)
        })
    }

    /// Whether a limit is folded back.
    #[must_use]
    pub fn folding(&self) -> bool {
        self.used.iter().any(|used| fold(*used) > 0.0)
    }

    /// Whether a motor takes more than the folded limit allows.
    #[must_use]
    pub fn overdrawn(&self) -> bool {
        self.used.max() > OVERDRAWN
    }
}

/// Share of the fold-back, 0 to 1.
fn fold(used: f64) -> f64 {
    ((used - FOLD_START) / (1.0 - FOLD_START)).clamp(0.0, 1.0)
}
