//! The moving linkage: dynamics, friction and stops, one semi-implicit step at a time.

use crate::friction::rub;
use crate::linkage::Linkage;
use crate::model::FrictionModel;
use crate::stops::Stops;
use hapticd_control::linear::{M3, V3};
use hapticd_control::model::KinematicsModel;

/// Where the tip is and how it moves with the joints.
#[derive(Clone, Copy, Debug)]
pub struct Tip {
    /// Position, m.
    pub position: V3,
    /// Velocity, m/s.
    pub velocity: V3,
    /// Jacobian, m/rad.
    pub jacobian: M3,
}

/// A linkage in motion.
#[derive(Clone, Copy, Debug)]
pub struct Mechanics<L> {
    linkage: L,
    kinematics: KinematicsModel,
    viscous: V3,
    coulomb: V3,
    stops: Stops,
    /// Joint angles, rad.
    pub q: V3,
    /// Joint velocities, rad/s.
    pub qd: V3,
    /// Dry-friction impulses of the last step, N·m·s.
    impulse: V3,
}

impl<L: Linkage> Mechanics<L> {
    /// At rest at `home`.
    #[must_use]
    pub fn new(
        linkage: L,
        kinematics: KinematicsModel,
        friction: &FrictionModel,
        stops: Stops,
        home: V3,
    ) -> Self {
        Self {
            linkage,
            kinematics,
            viscous: V3::from(friction.viscous_nm_s_per_rad),
            coulomb: V3::from(friction.coulomb_nm),
            stops,
            q: home,
            qd: V3::zeros(),
            impulse: V3::zeros(),
        }
    }

    /// The tip now.
    #[must_use]
    pub fn tip(&self) -> Tip {
        let jacobian = self.kinematics.jacobian(&self.q);
        Tip {
            position: self.kinematics.forward(&self.q),
            velocity: jacobian * self.qd,
            jacobian,
        }
    }

    /// One step of `h` (s) under joint torques and dry friction of `brake` (N·m) beside the bearings'.
    ///
    /// Returns the torque the brakes gave, N·m.
    pub fn advance(&mut self, torque: &V3, brake: &V3, h: f64) -> V3 {
        let (mass, bias) = self.linkage.dynamics(&self.q, &self.qd);
        let mobility = mass.try_inverse().unwrap_or_else(M3::zeros);
        let smooth = torque + self.stops.torque(&self.q, &self.qd)
            - bias
            - self.viscous.component_mul(&self.qd);
        let free = self.qd + mobility * smooth * h;
        let dry = self.coulomb + brake;
        self.qd = rub(&free, &mobility, &(dry * h), &mut self.impulse);
        self.q += self.qd * h;
        V3::from_fn(|i, _| {
            if dry[i] > 0.0 {
                self.impulse[i] / h * brake[i] / dry[i]
            } else {
                0.0
            }
        })
    }

    /// Kinetic and potential energy, J.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        0.5 * self.qd.dot(&(self.linkage.mass(&self.q) * self.qd))
            + self.linkage.potential_j(&self.q)
    }

    /// Apparent mass at the tip Λ⁻¹ = J M⁻¹ Jᵀ, 1/kg.
    #[must_use]
    pub fn tip_mobility(&self) -> M3 {
        let jacobian = self.kinematics.jacobian(&self.q);
        let mobility = self
            .linkage
            .mass(&self.q)
            .try_inverse()
            .unwrap_or_else(M3::zeros);
        jacobian * mobility * jacobian.transpose()
    }
}
