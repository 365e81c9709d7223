//! From encoder counts to joint and tip motion.

use crate::linear::{M3, V3};
use crate::model::{DeviceModel, KinematicsModel};

/// Where the device is and how fast it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointState {
    /// Joint angles, rad.
    pub q: V3,
    /// Filtered joint velocities, rad/s.
    pub qd: V3,
    /// Tip position, m.
    pub x: V3,
    /// Tip velocity J q̇, m/s.
    pub xd: V3,
    /// J, m/rad.
    pub jacobian: M3,
    /// J⁻¹, rad/m; zero at a singularity.
    pub jacobian_inverse: M3,
    /// sin of the angle to the nearest singularity.
    pub singularity_margin: f64,
}

impl JointState {
    /// The state at joint angles `q`, rad, and velocities `qd`, rad/s.
    #[must_use]
    pub fn at(kinematics: &KinematicsModel, q: V3, qd: V3) -> Self {
        let jacobian = kinematics.jacobian(&q);
        let singularity_margin = kinematics.singularity_margin(&q);
        let jacobian_inverse = kinematics.invert(jacobian, singularity_margin);
        Self {
            q,
            qd,
            x: kinematics.forward(&q),
            xd: jacobian * qd,
            jacobian,
            jacobian_inverse: jacobian_inverse.unwrap_or_default(),
            singularity_margin,
        }
    }
}

/// Joint angles from counts; joint velocities through the filter λ/(s+λ) of WN §III.
#[derive(Clone, Copy, Debug)]
pub struct Estimator {
    kinematics: KinematicsModel,
    zero_rad: V3,
    rad_per_count: V3,
    lambda_rad_per_s: f64,
    counts: Option<[i64; 3]>,
    qd: V3,
}

impl Estimator {
    /// An estimator at rest that has seen no counts yet.
    #[must_use]
    pub fn new(model: &DeviceModel) -> Self {
        let signed_inverse = |counts: f64| if counts == 0.0 { 0.0 } else { counts.recip() };
        Self {
            kinematics: model.kinematics,
            zero_rad: model.joints.zero_rad.into(),
            rad_per_count: V3::from(model.joints.counts_per_rad).map(signed_inverse),
            lambda_rad_per_s: model.estimator.lambda_rad_per_s,
            counts: None,
            qd: V3::zeros(),
        }
    }

    /// Forgets all motion: the device rests at `counts`.
    pub fn reset(&mut self, counts: &[i64; 3]) {
        self.counts = Some(*counts);
        self.qd = V3::zeros();
    }

    /// Takes the counts of a new frame, `dt_s` after the previous one. After lost frames `dt_s`
    /// spans them all; where it is not positive the velocity stays as it was.
    pub fn update(&mut self, counts: &[i64; 3], dt_s: f64) -> JointState {
        let before = self.counts.replace(*counts).unwrap_or(*counts);
        if dt_s > 0.0 {
            let step = self.step_rad(&before, counts);
            // Exact for a velocity that is constant between the frames.
            let keep = (-self.lambda_rad_per_s * dt_s).exp();
            self.qd = keep * self.qd + (1.0 - keep) / dt_s * step;
        }
        JointState::at(&self.kinematics, self.joint_angles(counts), self.qd)
    }

    /// Joint angles at `counts`, rad.
    #[must_use]
    pub fn joint_angles(&self, counts: &[i64; 3]) -> V3 {
        let counts = V3::from(counts.map(|count| count as f64));
        self.zero_rad + self.rad_per_count.component_mul(&counts)
    }

    /// Subtracts whole counts, so that a large count costs no resolution.
    fn step_rad(&self, before: &[i64; 3], after: &[i64; 3]) -> V3 {
        V3::from_fn(|i, _| after[i].wrapping_sub(before[i]) as f64 * self.rad_per_count[i])
    }
}
