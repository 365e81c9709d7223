//! A torque-commanded motor: limit and first-order lag.

use crate::model::MotorTwinModel;
use hapticd_control::model::TorqueDriveModel;

/// The torque a motor gives behind the torque it is asked for, at the joint.
#[derive(Clone, Copy, Debug)]
pub struct TorqueMotor {
    torque_max_nm: f64,
    scale: f64,
    /// Share of the way to the new torque in one step.
    approach: f64,
    asked_nm: f64,
    torque_nm: f64,
}

impl TorqueMotor {
    /// The motor of joint `axis` in steps of `h` (s).
    #[must_use]
    pub fn new(drive: &TorqueDriveModel, model: &MotorTwinModel, axis: usize, h: f64) -> Self {
        Self {
            torque_max_nm: drive.torque_max_nm[axis],
            scale: model.torque_scale[axis],
            approach: 1.0 - (-h / (drive.lag_s * model.lag_scale)).exp(),
            asked_nm: 0.0,
            torque_nm: 0.0,
        }
    }

    /// Takes the torque asked of the motor for this tick, N·m.
    pub fn ask(&mut self, torque_nm: f64) {
        self.asked_nm = self.scale * torque_nm.clamp(-self.torque_max_nm, self.torque_max_nm);
    }

    /// One step; returns the torque at the joint, N·m.
    pub fn step(&mut self) -> f64 {
        self.torque_nm += self.approach * (self.asked_nm - self.torque_nm);
        self.torque_nm
    }

    /// The torque at the joint now, N·m.
    #[must_use]
    pub fn torque_nm(&self) -> f64 {
        self.torque_nm
    }
}
