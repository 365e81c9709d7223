//! One motor winding behind its spring-drive amplifier (WN §II).

use crate::model::WindingTwinModel;
use hapticd_control::model::{SpringDriveModel, ThermalModel};

/// Temperature coefficient of copper, 1/K.
const COPPER_PER_K: f64 = 0.003_93;

/// Temperature at which resistances are given, °C.
const REFERENCE_C: f64 = 25.0;

/// Winding, amplifier with analogue resistance cancellation, and their heat.
#[derive(Clone, Copy, Debug)]
pub struct Winding {
    k_t: f64,
    r_25: f64,
    r_hat: f64,
    l: f64,
    supply_v: f64,
    current_max_a: f64,
    ripple: f64,
    /// Ripple periods per motor turn: radians of ripple per radian of motor.
    ripple_periods: f64,
    thermal: ThermalModel,
    /// Current i, A.
    pub current_a: f64,
    /// Winding temperature, °C.
    pub winding_c: f64,
    case_c: f64,
    /// ∫ i² R dt since the last heat step, J.
    loss_j: f64,
}

impl Winding {
    /// The winding of motor `axis`, cold and without current.
    #[must_use]
    pub fn new(drive: &SpringDriveModel, model: &WindingTwinModel, axis: usize) -> Self {
        Self {
            k_t: drive.k_t_nm_per_a[axis] * model.k_t_scale[axis],
            r_25: drive.r_25_ohm[axis] * model.r_scale[axis],
            r_hat: drive.r_hat_ohm[axis] * model.r_hat_scale[axis],
            l: drive.l_h[axis] * model.l_scale[axis],
            supply_v: model.supply_v,
            current_max_a: drive.current_max_a[axis],
            ripple: model.brush_ripple,
            ripple_periods: model.brush_periods,
            thermal: drive.thermal,
            current_a: 0.0,
            winding_c: drive.thermal.ambient_c,
            case_c: drive.thermal.ambient_c,
            loss_j: 0.0,
        }
    }

    /// R(T, θ) at motor angle `theta` (rad), Ω.
    #[must_use]
    pub fn resistance_ohm(&self, theta: f64) -> f64 {
        let warm = self.r_25 * (1.0 + COPPER_PER_K * (self.winding_c - REFERENCE_C));
        warm * (1.0 + self.ripple * (self.ripple_periods * theta).cos())
    }

    /// One step of `h` (s) with the amplifier asked for `e_w` (V, WN eq. 6) at motor angle `theta`
    /// (rad) and speed `omega` (rad/s). Returns the motor torque, N·m.
    pub fn drive(&mut self, e_w: f64, theta: f64, omega: f64, h: f64) -> f64 {
        let r = self.resistance_ohm(theta);
        let back_emf = self.k_t * omega;
        let mut next = self.settle(e_w - back_emf, r - self.r_hat, h);
        // e_A = R̂ i + e_W cannot leave the supply; then the motor sees the supply alone.
        let e_a = self.r_hat * 0.5 * (self.current_a + next) + e_w;
        if e_a.abs() > self.supply_v {
            next = self.settle(self.supply_v.copysign(e_a) - back_emf, r, h);
        }
        self.carry(next.clamp(-self.current_max_a, self.current_max_a), r, h)
    }

    /// One step with the bridge off: its diodes return the current to the supply.
    pub fn release(&mut self, theta: f64, h: f64) -> f64 {
        let fall = self.supply_v / self.l * h;
        let left = (self.current_a.abs() - fall)
            .max(0.0)
            .copysign(self.current_a);
        self.carry(left, self.resistance_ohm(theta), h)
    }

    /// Current after `h` of L di/dt = e − r i, trapezoidal.
    fn settle(&self, e: f64, r: f64, h: f64) -> f64 {
        let (l, drop) = (self.l, 0.5 * h * r);
        (self.current_a * (l - drop) + h * e) / (l + drop)
    }

    /// Motor torque now, N·m.
    #[must_use]
    pub fn torque_nm(&self) -> f64 {
        self.k_t * self.current_a
    }

    fn carry(&mut self, current: f64, r: f64, h: f64) -> f64 {
        self.current_a = current;
        self.loss_j += current * current * r * h;
        self.torque_nm()
    }

    /// Turns the losses of the last `dt` (s) into heat: two nodes, winding and case.
    pub fn heat(&mut self, dt: f64) {
        let t = &self.thermal;
        let winding_j_per_k = t.winding_s / t.winding_case_k_per_w;
        let case_j_per_k = t.case_s / t.case_ambient_k_per_w;
        let inward_w = (self.winding_c - self.case_c) / t.winding_case_k_per_w;
        let outward_w = (self.case_c - t.ambient_c) / t.case_ambient_k_per_w;
        self.winding_c += (self.loss_j - inward_w * dt) / winding_j_per_k;
        self.case_c += (inward_w - outward_w) * dt / case_j_per_k;
        self.loss_j = 0.0;
    }
}
