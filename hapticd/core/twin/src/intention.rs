//! Where the operator means the hand to be: the moving end of the arm's spring.

use crate::model::HandModel;
use crate::script::Script;
use core::f64::consts::TAU;
use hapticd_control::linear::V3;

/// Time in which the last of a push builds up, s; keeps the advance smooth near the wanted force.
const ADVANCE_S: f64 = 0.02;

/// Time in which a stroke grows to its amplitude, s.
const STROKE_BLEND_S: f64 = 0.5;

/// The reach has arrived when it is this close, m, and this slow, m/s.
const ARRIVED_M: f64 = 5e-4;
const ARRIVED_M_PER_S: f64 = 5e-3;

/// The operator's intention x_i and its velocity.
#[derive(Clone, Copy, Debug)]
pub struct Intention {
    script: Script,
    /// x_i, m.
    pub position: V3,
    /// v_i, m/s.
    pub velocity: V3,
    /// Where it was when the script's path began, m.
    start: V3,
    /// Time since the script's path began, s.
    time_s: f64,
    /// A minimum-jerk path has been reached and is under way.
    underway: bool,
}

impl Intention {
    /// An intention to stay at `position` (m) that begins `script`.
    #[must_use]
    pub fn new(script: Script, position: V3) -> Self {
        Self {
            script,
            position,
            velocity: V3::zeros(),
            start: position,
            time_s: 0.0,
            underway: false,
        }
    }

    /// One step of `h` (s) with the hand at `hand` (m) and the arm's stiffness `k_a` (N/m).
    pub fn advance(&mut self, model: &HandModel, hand: &V3, k_a: f64, h: f64) {
        self.time_s += h;
        match self.script {
            Script::Free | Script::Hold { .. } => self.velocity = V3::zeros(),
            Script::Follow { target_m } => self.reach(model, &V3::from(target_m), h),
            Script::Clamp { position_m } => self.reach(model, &V3::from(position_m), h),
            Script::Push {
                direction,
                force_n,
                speed_m_per_s,
            } => {
                let direction = V3::from(direction).normalize();
                let stretch = (self.position - hand).dot(&direction);
                let gap = force_n / k_a - stretch;
                let pace = if gap > 0.0 {
                    (gap / ADVANCE_S).min(speed_m_per_s)
                } else {
                    gap / model.relax_s
                };
                self.velocity = direction * pace;
                self.position += self.velocity * h;
            }
            Script::Stroke {
                center_m,
                axis,
                amplitude_m,
                frequency_hz,
            } => {
                let stroke = V3::from(axis).normalize() * amplitude_m;
                self.swing(&V3::from(center_m), &stroke, TAU * frequency_hz, h);
            }
            Script::MinimumJerk {
                from_m,
                to_m,
                duration_s,
            } => {
                self.travel(model, &V3::from(from_m), &V3::from(to_m), duration_s, h);
            }
        }
    }

    /// Critically damped pursuit of `target`, its speed limited.
    fn reach(&mut self, model: &HandModel, target: &V3, h: f64) {
        let omega = model.reach_rad_per_s;
        let pull = (target - self.position) * (omega * omega) - self.velocity * (2.0 * omega);
        self.velocity = (self.velocity + pull * h).cap_magnitude(model.reach_m_per_s);
        self.position += self.velocity * h;
    }

    fn swing(&mut self, center: &V3, stroke: &V3, omega: f64, h: f64) {
        let weight = minimum_jerk(self.time_s / STROKE_BLEND_S);
        let wave = center + stroke * (omega * self.time_s).sin();
        self.go(&(self.start * (1.0 - weight) + wave * weight), h);
    }

    fn travel(&mut self, model: &HandModel, from: &V3, to: &V3, duration_s: f64, h: f64) {
        if !self.underway {
            self.reach(model, from, h);
            let close = (self.position - from).norm() < ARRIVED_M;
            if close && self.velocity.norm() < ARRIVED_M_PER_S {
                self.underway = true;
                self.time_s = 0.0;
                self.start = self.position;
            }
            return;
        }
        let share = minimum_jerk(self.time_s / duration_s);
        self.go(&(self.start + (to - self.start) * share), h);
    }

    fn go(&mut self, to: &V3, h: f64) {
        self.velocity = (to - self.position) / h;
        self.position = *to;
    }
}

/// Share of a minimum-jerk path covered at time `s` of 0 to 1 (Flash & Hogan).
fn minimum_jerk(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}
