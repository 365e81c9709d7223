//! The sampled loop behind a damper: how hard one it can damp with.

use core::f64::consts::FRAC_PI_2;

/// Periods from a motion to the force against it: half of one for the difference that gives the
/// velocity, one for the exchange, half of one while the force is held.
const DELAY_TICKS: f64 = 2.0;

/// Halvings of an interval that reach the rounding.
const HALVINGS: usize = 60;

/// A free mass, its velocity through λ/(s+λ), and a force that lags.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledLoop {
    /// T, s.
    pub period_s: f64,
    /// The drive's lag, s.
    pub lag_s: f64,
    /// λ of the velocity filter, rad/s.
    pub lambda_rad_per_s: f64,
}

impl SampledLoop {
    /// Damping per mass, 1/s, with which the force comes a quarter turn late:
    /// B/m = ω √(1 + (ω lag)²) √(1 + (ω/λ)²) at the ω of [`SampledLoop::crossover_rad_per_s`].
    ///
    /// The loop itself swings from some 17 % more on, which is the margin.
    #[must_use]
    pub fn damping_max_per_s(&self) -> f64 {
        let w = self.crossover_rad_per_s();
        w * (w * self.lag_s).hypot(1.0) * (w / self.lambda_rad_per_s).hypot(1.0)
    }

    /// ω, rad/s, at which delay, lag and filter turn the force by 90°, which with the mass's own
    /// 90° pushes the way the mass goes.
    fn crossover_rad_per_s(&self) -> f64 {
        let delay_s = DELAY_TICKS * self.period_s;
        let late =
            |w: f64| w * delay_s + (w * self.lag_s).atan() + (w / self.lambda_rad_per_s).atan();
        let (mut low, mut high) = (0.0, FRAC_PI_2 / delay_s);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if late(middle) < FRAC_PI_2 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}
