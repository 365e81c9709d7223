//! Joint angles to tip and back, for both linkages.

mod phantom;
mod rhombus;

use crate::linear::{M3, V3};
use crate::model::{JointModel, KinematicsModel};
use phantom::Phantom;
use rhombus::Rhombus;

/// Singularity margin below which the Jacobian counts as singular: its inverse would lose
/// half of the digits.
const SINGULAR: f64 = 1e-8;

/// Two joints whose difference the linkage limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Index of the joint subtracted.
    pub from: usize,
    /// Index of the joint it is subtracted from.
    pub to: usize,
    /// Smallest difference, rad.
    pub min_rad: f64,
    /// Largest difference, rad.
    pub max_rad: f64,
}

impl KinematicsModel {
    /// Tip position in the base frame, m, for joint angles `q`, rad.
    #[must_use]
    pub fn forward(&self, q: &V3) -> V3 {
        match self.linkage() {
            Linkage::Phantom(linkage) => linkage.forward(q),
            Linkage::Rhombus(linkage) => linkage.forward(q),
        }
    }

    /// ∂x/∂q, m/rad, one column per joint.
    #[must_use]
    pub fn jacobian(&self, q: &V3) -> M3 {
        match self.linkage() {
            Linkage::Phantom(linkage) => linkage.jacobian(q),
            Linkage::Rhombus(linkage) => linkage.jacobian(q),
        }
    }

    /// Joint angles, rad, of the tip position `x`, m; `None` where the linkage does not reach or
    /// the angles are not determined. Joint limits are not looked at: see [`Self::inside`].
    #[must_use]
    pub fn inverse(&self, x: &V3) -> Option<V3> {
        match self.linkage() {
            Linkage::Phantom(linkage) => linkage.inverse(x),
            Linkage::Rhombus(linkage) => linkage.inverse(x),
        }
    }

    /// ∂q/∂x, rad/m, zero in the unused row and column; `None` at a singularity.
    #[must_use]
    pub fn jacobian_inverse(&self, q: &V3) -> Option<M3> {
        self.invert(self.jacobian(q), self.singularity_margin(q))
    }

    /// [`Self::jacobian_inverse`] from what is already known of a pose.
    pub(crate) fn invert(&self, jacobian: M3, singularity_margin: f64) -> Option<M3> {
        if singularity_margin <= SINGULAR {
            return None;
        }
        match self {
            Self::Phantom { .. } => jacobian.try_inverse(),
            Self::Rhombus { .. } => invert_planar(jacobian),
        }
    }

    /// sin of the angle to the nearest singularity: 1 far from any, 0 at one or past it.
    #[must_use]
    pub fn singularity_margin(&self, q: &V3) -> f64 {
        match self.linkage() {
            Linkage::Phantom(linkage) => linkage.singularity_margin(q),
            Linkage::Rhombus(linkage) => linkage.singularity_margin(q),
        }
    }

    /// Whether each joint, and the difference of the coupled two, is within its limits widened
    /// by `margin_rad`. Never for NaN.
    #[must_use]
    pub fn inside(&self, joints: &JointModel, q: &V3, margin_rad: f64) -> bool {
        let within =
            |value: f64, min: f64, max: f64| (min - margin_rad..=max + margin_rad).contains(&value);
        let coupling = self.coupling();
        let difference = q[coupling.to] - q[coupling.from];
        (0..3).all(|i| within(q[i], joints.min_rad[i], joints.max_rad[i]))
            && within(difference, coupling.min_rad, coupling.max_rad)
    }

    /// The pair of joints whose difference is limited.
    #[must_use]
    pub fn coupling(&self) -> Coupling {
        let (from, min_rad, max_rad) = match *self {
            Self::Phantom {
                coupling_min_rad,
                coupling_max_rad,
                ..
            } => (1, coupling_min_rad, coupling_max_rad),
            Self::Rhombus {
                opening_min_rad,
                opening_max_rad,
                ..
            } => (0, opening_min_rad, opening_max_rad),
        };
        Coupling {
            from,
            to: from + 1,
            min_rad,
            max_rad,
        }
    }

    fn linkage(&self) -> Linkage {
        match *self {
            Self::Phantom { l1_m, l2_m, .. } => Linkage::Phantom(Phantom { l1: l1_m, l2: l2_m }),
            Self::Rhombus { l_m, .. } => Linkage::Rhombus(Rhombus { l: l_m }),
        }
    }
}

enum Linkage {
    Phantom(Phantom),
    Rhombus(Rhombus),
}

/// Inverse of the upper left 2×2 block, the rest zero.
fn invert_planar(mut jacobian: M3) -> Option<M3> {
    jacobian[(2, 2)] = 1.0;
    let mut inverse = jacobian.try_inverse()?;
    inverse[(2, 2)] = 0.0;
    Some(inverse)
}

/// acos, or `None` outside its domain; NaN is outside.
fn acos_within(cosine: f64) -> Option<f64> {
    (-1.0..=1.0).contains(&cosine).then(|| cosine.acos())
}
