//! Winding temperature, and the resistance that follows from it.

use crate::linear::V3;
use crate::model::{SpringDriveModel, ThermalModel};

/// Temperature coefficient of copper at 25 °C, 1/K.
const COPPER_PER_K: f64 = 0.00393;
/// Temperature at which a winding has its data-sheet resistance, °C.
const REFERENCE_C: f64 = 25.0;
/// Smallest residual resistance dR that is believed, as a fraction of R at 25 °C: below it the
/// cancellation is at its stability limit and every formula divides by dR (physics §2.1).
const RESIDUAL_FLOOR: f64 = 0.01;

/// R(T) = R₂₅ (1 + 0.00393 ΔT), Ω (physics §1.1).
#[must_use]
pub fn resistance_ohm(r_25_ohm: f64, winding_c: f64) -> f64 {
    r_25_ohm * (1.0 + COPPER_PER_K * (winding_c - REFERENCE_C))
}

/// dR = R(T) − R̂, Ω, never below its floor.
#[must_use]
pub fn residual_ohm(r_25_ohm: f64, r_hat_ohm: f64, winding_c: f64) -> f64 {
    let floor = RESIDUAL_FLOOR * r_25_ohm;
    (resistance_ohm(r_25_ohm, winding_c) - r_hat_ohm).max(floor)
}

/// dR of every winding at its data-sheet temperature, Ω: what the drive was tuned with.
#[must_use]
pub fn tuned_residual_ohm(drive: &SpringDriveModel) -> V3 {
    V3::from_fn(|i, _| residual_ohm(drive.r_25_ohm[i], drive.r_hat_ohm[i], REFERENCE_C))
}

/// Two-node model of every motor: winding on case on ambient (physics §1.1).
#[derive(Clone, Copy, Debug)]
pub struct Thermal {
    model: ThermalModel,
    r_25_ohm: V3,
    r_hat_ohm: V3,
    winding_approach: f64,
    case_approach: f64,
    winding_c: V3,
    case_c: V3,
}

impl Thermal {
    /// Motors at ambient temperature, stepped every `period_s`.
    #[must_use]
    pub fn new(drive: &SpringDriveModel, period_s: f64) -> Self {
        let approach = |time_s: f64| 1.0 - (-period_s / time_s).exp();
        let ambient_c = V3::repeat(drive.thermal.ambient_c);
        Self {
            model: drive.thermal,
            r_25_ohm: drive.r_25_ohm.into(),
            r_hat_ohm: drive.r_hat_ohm.into(),
            winding_approach: approach(drive.thermal.winding_s),
            case_approach: approach(drive.thermal.case_s),
            winding_c: ambient_c,
            case_c: ambient_c,
        }
    }

    /// One period with `current_a` in the windings. Each node goes towards where it would rest;
    /// that is stable at any period.
    pub fn step(&mut self, current_a: &V3) {
        for i in 0..3 {
            let loss_w = current_a[i].powi(2) * resistance_ohm(self.r_25_ohm[i], self.winding_c[i]);
            let flow_w = (self.winding_c[i] - self.case_c[i]) / self.model.winding_case_k_per_w;
            let winding_c = self.case_c[i] + loss_w * self.model.winding_case_k_per_w;
            let case_c = self.model.ambient_c + flow_w * self.model.case_ambient_k_per_w;
            self.winding_c[i] += self.winding_approach * (winding_c - self.winding_c[i]);
            self.case_c[i] += self.case_approach * (case_c - self.case_c[i]);
        }
    }

    /// Winding temperatures, °C.
    #[must_use]
    pub fn winding_c(&self) -> V3 {
        self.winding_c
    }

    /// Residual resistances dR, Ω.
    #[must_use]
    pub fn residual_ohm(&self) -> V3 {
        V3::from_fn(|i, _| residual_ohm(self.r_25_ohm[i], self.r_hat_ohm[i], self.winding_c[i]))
    }

    /// Whether a winding is past its limit.
    #[must_use]
    pub fn hot(&self) -> bool {
        self.winding_c.max() > self.model.winding_max_c
    }
}
