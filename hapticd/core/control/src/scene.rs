//! The scene as the loop sees it: flat, fixed-size, already validated.

use crate::io::Axes;
use serde::{Deserialize, Serialize};

/// Most walls one scene holds.
pub const MAX_WALLS: usize = 256;

/// How a set-point of the tip becomes set-points of the joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mapping {
    /// q_Sd = q + K_q⁻¹ Jᵀ k_c (x_Sd − x): the isotropic one (WN eq. 23, 24).
    #[default]
    Transpose,
    /// q_Sd = invkin(x_Sd): each joint as stiff as it is tuned (WN eq. 18).
    Inverse,
}

/// Where the isotropic stiffness k_c comes from (WN §V, after eq. 29).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessScope {
    /// The largest bound of the present pose.
    #[default]
    Pose,
    /// The smallest bound over the workspace: one stiffness everywhere.
    Workspace,
}

/// Which actuators share the joint torque (KS §1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Allocation {
    /// Motors alone.
    MotorOnly,
    /// Brakes where they can dissipate, motors the rest.
    #[default]
    MotorAndBrake,
    /// Brakes alone.
    BrakeOnly,
}

/// A half-space with a motion law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Unit normal into free space, base frame.
    pub normal: Axes,
    /// Plane offset n·p, m: free space is n·x ≥ `offset_m`.
    pub offset_m: f64,
    /// 0 rigid … 1 free (WN eq. 30).
    pub eta: f64,
}

/// Everything one device renders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Revision the front gave it; echoed in every tick record.
    pub revision: u64,
    /// Time over which it replaces its predecessor, s.
    pub fade_s: f64,
    /// Joint mapping.
    pub mapping: Mapping,
    /// Source of k_c.
    pub stiffness: StiffnessScope,
    /// Actuator sharing.
    pub allocation: Allocation,
    /// Number of walls in use.
    pub count: usize,
    /// The walls; those past `count` are unused.
    pub walls: [Wall; MAX_WALLS],
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            revision: 0,
            fade_s: 0.0,
            mapping: Mapping::default(),
            stiffness: StiffnessScope::default(),
            allocation: Allocation::default(),
            count: 0,
            walls: [Wall::default(); MAX_WALLS],
        }
    }
}

impl Scene {
    /// The walls in use.
    #[must_use]
    pub fn walls(&self) -> &[Wall] {
        &self.walls[..self.count.min(MAX_WALLS)]
    }
}
