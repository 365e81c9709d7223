//! Friction by brakes: which way one wall's friction points, and how much it may hold.

use super::coupling::{tangential, Limits, Motion};
use crate::linear::V3;

/// Speed past which a held tip slides, m/s.
const SLIDING_M_PER_S: f64 = 0.004;
/// Speed below which it rests again, m/s (Karnopp, physics §7).
const RESTING_M_PER_S: f64 = 0.002;
/// Time over which the speed is averaged, s: several encoder counts at these speeds.
const AVERAGE_S: f64 = 0.01;
/// Pull of the hand below which it points nowhere, N: three times the force sensor's noise.
const PULL_MIN_N: f64 = 0.3;

/// Direction in which the tip slides along one wall, or in which the hand pulls it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    velocity: V3,
    direction: V3,
    sticks: bool,
}

impl Default for Heading {
    fn default() -> Self {
        Self {
            velocity: V3::zeros(),
            direction: V3::zeros(),
            sticks: true,
        }
    }
}

impl Heading {
    /// Force that the brakes may give, N: μ_k N against the slip, or μ_s N against the pull. A
    /// brake never drives, so that it needs no cap by the pull itself (KS §5).
    pub(super) fn force_n(&mut self, normal: &V3, limits: &Limits, motion: &Motion) -> V3 {
        let approach = (motion.period_s / AVERAGE_S).min(1.0);
        self.velocity += approach * (tangential(&motion.velocity, normal) - self.velocity);
        let speed = self.velocity.norm();
        if speed > SLIDING_M_PER_S {
            self.sticks = false;
        } else if speed < RESTING_M_PER_S {
            self.sticks = true;
        }
        self.turn(normal, speed, motion.hand_n);
        let limit_n = if self.sticks {
            limits.static_n
        } else {
            limits.kinetic_n
        };
        -limit_n * self.direction
    }

    /// Whether the tip rests on the wall.
    pub(super) fn sticks(&self) -> bool {
        self.sticks
    }

    /// Points along the slip, or along the pull. Without either it stays: the brakes then hold
    /// what comes.
    fn turn(&mut self, normal: &V3, speed: f64, hand_n: Option<V3>) {
        if !self.sticks {
            self.direction = self.velocity / speed;
        } else if let Some(hand_n) = hand_n {
            let pull_n = tangential(&hand_n, normal);
            if pull_n.norm() > PULL_MIN_N {
                self.direction = pull_n.normalize();
            }
        }
    }
}
