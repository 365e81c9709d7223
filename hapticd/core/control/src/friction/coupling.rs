//! What the walls' friction shares in one tick: the motion of the tip, and the spring of an anchor.

use crate::couple::dc_stiffness;
use crate::estimate::JointState;
use crate::linear::{invert_axes, V3};
use crate::mapping::isotropic_stiffness;
use crate::model::{DriveModel, SpringDriveModel};
use crate::thermal::tuned_residual_ohm;

/// Share of the coupling's stiffness that one anchor has. In a corner the anchor of one wall
/// stands beside the spring of the other: 1.5 times the coupling, which the device still stands.
const ANCHOR_SHARE: f64 = 0.5;

/// Ticks from a count to the middle of the force that answers it: one exchange, half a hold.
const TICKS: f64 = 1.5;

/// Motion of the tip since the last tick, and what a new anchor is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Way of the tip, m.
    pub(super) step_m: V3,
    /// Velocity of the tip, m/s.
    pub(super) velocity: V3,
    /// Force of the hand, N, where it is measured.
    pub(super) hand_n: Option<V3>,
    /// Spring and damper of an anchor.
    pub(super) coupling: Coupling,
    /// Tick period, s.
    pub(super) period_s: f64,
}

/// Largest friction force of one wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// μ_s N.
    pub(super) static_n: f64,
    /// μ_k N.
    pub(super) kinetic_n: f64,
}

/// Spring and damper between anchor and tip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coupling {
    /// Spring, N/m.
    pub(super) stiffness_n_per_m: f64,
    /// Damper beside it, N·s/m.
    pub(super) damping_n_s_per_m: f64,
}

/// Where the anchors of a device have their spring from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Springs {
    /// The virtual coupling of torque drives: the same everywhere.
    Torque(Coupling),
    /// Spring drives: k_c of the pose, from the stiffness of the joints.
    Spring {
        /// K_DC at the joints, N·m/rad.
        k_q: V3,
        /// L/dR of the slowest winding and the delay of a tick, s.
        lag_s: f64,
    },
}

impl Springs {
    /// The springs that `drive` bears.
    pub(super) fn new(drive: &DriveModel, period_s: f64) -> Self {
        match drive {
            DriveModel::Torque(drive) => Self::Torque(Coupling {
                stiffness_n_per_m: ANCHOR_SHARE * drive.stiffness_n_per_m,
                damping_n_s_per_m: ANCHOR_SHARE * drive.damping_n_s_per_m,
            }),
            DriveModel::Spring(drive) => Self::of_windings(drive, period_s),
        }
    }

    fn of_windings(drive: &SpringDriveModel, period_s: f64) -> Self {
        let dr_ohm = tuned_residual_ohm(drive);
        let winding_s = V3::from(drive.l_h).component_mul(&invert_axes(&dr_ohm));
        Self::Spring {
            k_q: dc_stiffness(drive, &dr_ohm),
            lag_s: winding_s.max() + TICKS * period_s,
        }
    }

    /// The spring at a pose. That of a spring drive has the damper k·t beside it, t being the lag
    /// of winding and loop, which it makes up for (K_P = k_T dR/L, physics §2.1).
    pub(super) fn at(&self, state: &JointState) -> Coupling {
        match self {
            Self::Torque(coupling) => *coupling,
            Self::Spring { k_q, lag_s } => {
                let stiffness_n_per_m = ANCHOR_SHARE * isotropic_stiffness(&state.jacobian, k_q);
                Coupling {
                    stiffness_n_per_m,
                    damping_n_s_per_m: stiffness_n_per_m * lag_s,
                }
            }
        }
    }
}

/// The part of `vector` along a surface.
pub(super) fn tangential(vector: &V3, normal: &V3) -> V3 {
    vector - normal * normal.dot(vector)
}
