//! What a particle brake can give: dead time, hysteresis and lag (physics §4.3).

use crate::linear::V3;
use crate::model::BrakeModel;

/// The brakes of one device, as a model that follows the commands.
#[derive(Clone, Debug)]
pub struct Brakes {
    model: BrakeModel,
    approach: f64,
    /// Commands on their way through the dead time, as fractions of rated torque.
    delayed: Vec<V3>,
    next: usize,
    play: V3,
    torque_nm: V3,
}

impl Brakes {
    /// Brakes released and at rest, stepped every `period_s`.
    #[must_use]
    pub fn new(model: &BrakeModel, period_s: f64) -> Self {
        let dead_ticks = (model.dead_time_s / period_s).round() as usize;
        Self {
            model: *model,
            // Without lag the exponent is −∞ and the torque follows at once.
            approach: 1.0 - (-period_s / model.lag_s).exp(),
            delayed: vec![V3::zeros(); dead_ticks],
            next: 0,
            play: V3::zeros(),
            torque_nm: V3::zeros(),
        }
    }

    /// One period with `asked_nm`, N·m, commanded:
    /// z ← clip(z, u−r, u+r), c ← c + (1−e^(−T/lag)) (τ_rated max(z, 0) − c).
    pub fn step(&mut self, asked_nm: &V3) {
        let u = self.delay(fraction(asked_nm, &self.model.torque_max_nm.into()));
        let r = self.model.hysteresis;
        for i in 0..3 {
            self.play[i] = self.play[i].clamp(u[i] - r, u[i] + r);
            let target_nm = self.model.torque_max_nm[i] * self.play[i].max(0.0);
            self.torque_nm[i] += self.approach * (target_nm - self.torque_nm[i]);
        }
    }

    /// Torque ĉ that the commands have built up, N·m, without the drag.
    #[must_use]
    pub fn torque_nm(&self) -> V3 {
        self.torque_nm
    }

    /// Torque the brakes can give, N·m: ĉ and the drag.
    #[must_use]
    pub fn capacity_nm(&self) -> V3 {
        self.torque_nm + V3::from(self.model.drag_nm)
    }

    /// Joint torque of the brakes, N·m: against the motion, or at rest against `other_nm`, N·m,
    /// the sum of all other torques, as far as they can.
    #[must_use]
    pub fn reaction_nm(&self, qd: &V3, other_nm: &V3) -> V3 {
        let capacity_nm = self.capacity_nm();
        V3::from_fn(|i, _| {
            let held_nm = other_nm[i].clamp(-capacity_nm[i], capacity_nm[i]);
            if qd[i].abs() < self.model.omega_off_rad_per_s {
                -held_nm
            } else {
                -qd[i].signum() * capacity_nm[i]
            }
        })
    }

    /// Swaps the newest command for the one that the dead time lets through.
    fn delay(&mut self, u: V3) -> V3 {
        let Some(slot) = self.delayed.get_mut(self.next) else {
            return u;
        };
        let due = core::mem::replace(slot, u);
        self.next = (self.next + 1) % self.delayed.len();
        due
    }
}

fn fraction(asked_nm: &V3, rated_nm: &V3) -> V3 {
    asked_nm.zip_map(
        rated_nm,
        |asked, rated| {
            if rated > 0.0 {
                asked / rated
            } else {
                0.0
            }
        },
    )
}
