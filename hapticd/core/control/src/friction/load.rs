//! How hard the hand presses each wall.

use super::{Rubbing, MAX_RUBBING};
use crate::linear::V3;

/// Cut-off of the measured force, Hz: past it the noise of the sensor would rub.
const CUT_OFF_HZ: f64 = 100.0;

/// Sweeps over the walls; two walls of a corner at 60° settle to 1 % of the force.
const SWEEPS: usize = 8;

/// The measured force of the hand, low-passed.
#[derive(Clone, Copy, Debug)]
pub(super) struct HandFilter {
    approach: f64,
    force_n: Option<V3>,
}

impl HandFilter {
    /// A filter that has seen nothing, used every `period_s`.
    pub(super) fn new(period_s: f64) -> Self {
        let omega = core::f64::consts::TAU * CUT_OFF_HZ;
        Self {
            approach: 1.0 - (-omega * period_s).exp(),
            force_n: None,
        }
    }

    /// The force after one more reading, N. Without a reading the filter forgets.
    pub(super) fn follow(&mut self, measured_n: Option<&V3>) -> Option<V3> {
        self.force_n = measured_n.map(|measured_n| match self.force_n {
            Some(before_n) => before_n + self.approach * (measured_n - before_n),
            None => *measured_n,
        });
        self.force_n
    }
}

/// Normal force of each wall, N: as rendered, or such that the walls together answer the measured
/// force of the hand, −F = Σ N_i n_i with N_i ≥ 0, from the rendered forces by Gauss–Seidel.
/// Among walls that are all slippery nobody asks for it.
pub(super) fn shared_normal_n(rubbing: &[Rubbing], hand_n: Option<&V3>) -> [f64; MAX_RUBBING] {
    let mut normal_n = [0.0; MAX_RUBBING];
    let slippery = |rub: &Rubbing| rub.friction.static_ == 0.0 && rub.friction.kinetic == 0.0;
    if rubbing.iter().all(slippery) {
        return normal_n;
    }
    for (normal_n, rub) in normal_n.iter_mut().zip(rubbing) {
        *normal_n = rub.normal_n.max(0.0);
    }
    if let Some(hand_n) = hand_n {
        let rendered = rubbing.iter().zip(&normal_n);
        let mut rest_n = rendered.fold(*hand_n, |rest_n, (rub, n)| rest_n + *n * rub.normal);
        for _ in 0..SWEEPS {
            for (normal_n, rub) in normal_n.iter_mut().zip(rubbing) {
                let wanted_n = (*normal_n - rub.normal.dot(&rest_n)).max(0.0);
                rest_n += (wanted_n - *normal_n) * rub.normal;
                *normal_n = wanted_n;
            }
        }
    }
    normal_n
}
