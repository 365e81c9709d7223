//! What motors take off a resting hand that pulls against brakes which have been let go, and whose
//! torque still decays. While the joint moves they cancel all of it (physics §5).

use crate::model::BrakeModel;

/// Share of the decaying torque that motors take at rest. What is left of it keeps the joint from
/// being moved by motors alone, with a model that is wrong by a tenth (physics §5) and brakes that
/// ripple by a twentieth (§4.3).
pub const SHARE: f64 = 0.8;

/// Pull, in dead zones of the force sensor, at which they take all of that share: from one on it
/// grows evenly, so that noise does not switch it.
const FULL_AT: f64 = 3.0;

/// One joint whose brake has been let go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Decay {
    /// ĉ, N·m: what the brake still has.
    pub brake_nm: f64,
    /// q̇, rad/s.
    pub qd: f64,
    /// Torque of the hand, N·m.
    pub hand_nm: f64,
    /// Torque of hand and motors, N·m.
    pub other_nm: f64,
}

impl Decay {
    /// Torque, N·m, that motors add the way the hand pulls, at most [`SHARE`] of ĉ; nothing where
    /// it does not pull, or where the motors pull harder the other way.
    #[must_use]
    pub fn relief_nm(&self, model: &BrakeModel) -> f64 {
        let least_nm = model.hand_torque_min_nm;
        let beyond_nm = self.pull_nm().abs() - least_nm;
        let grown = (beyond_nm / ((FULL_AT - 1.0) * least_nm)).clamp(0.0, 1.0);
        self.hand_nm.signum() * (grown * SHARE * self.brake_nm - self.cancelled_nm(model)).max(0.0)
    }

    /// The smaller of what the hand pulls with and what arrives at the joint, N·m.
    fn pull_nm(&self) -> f64 {
        if self.hand_nm * self.other_nm > 0.0 {
            self.hand_nm.abs().min(self.other_nm.abs())
        } else {
            0.0
        }
    }

    /// What the rule of moving joints cancels already, N·m: all, where the motion is against the
    /// hand.
    fn cancelled_nm(&self, model: &BrakeModel) -> f64 {
        let moving = self.qd.abs() >= model.omega_off_rad_per_s;
        let sense = (self.qd.abs() / model.omega_on_rad_per_s).min(1.0);
        match (moving, self.qd * self.hand_nm > 0.0) {
            (false, _) => 0.0,
            (true, true) => sense * self.brake_nm,
            (true, false) => self.brake_nm,
        }
    }
}
