//! The scene as the loop sees it: flat, fixed-size, already validated.

use crate::io::{Axes, AXES};
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

/// What a wall is made of. Unit vectors are of unit length; base frame. A two-joint device leaves
/// the third coordinate at zero, and its boxes reach far along it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum Shape {
    /// A half-space: free is n·x ≥ `offset_m`.
    Plane {
        /// Unit normal into free space.
        normal: Axes,
        /// n·p of a point p of the plane, m.
        offset_m: f64,
    },
    /// A ball, or its surface alone.
    Sphere {
        /// Centre, m.
        center_m: Axes,
        /// Radius, m.
        radius_m: f64,
        /// A shell, felt from the side on which the tip is.
        hollow: bool,
    },
    /// A cuboid, or its surface alone.
    Box {
        /// Centre, m.
        center_m: Axes,
        /// Unit vectors of its edges, perpendicular to each other.
        axes: [Axes; AXES],
        /// Half of each edge, m.
        half_m: Axes,
        /// A shell, felt from the side on which the tip is.
        hollow: bool,
    },
    /// Everything within a radius of a segment, or its surface alone.
    Capsule {
        /// One end of the segment, m.
        from_m: Axes,
        /// The other end, m.
        to_m: Axes,
        /// Radius, m.
        radius_m: f64,
        /// A shell, felt from the side on which the tip is.
        hollow: bool,
    },
}

/// Which form of the cubic damper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CubicForm {
    /// F = C w³ where C w³ + (m/T) w = (m/T) v: does not chatter (physics §6).
    #[default]
    Implicit,
    /// F = C v³ as printed (KS §4).
    Explicit,
}

/// How a wall answers penetration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum Law {
    /// The set-point penetrates by η times the depth (WN eq. 17, 30).
    Motion {
        /// 0 rigid … 1 free.
        eta: f64,
    },
    /// A spring, and a damper that never pulls.
    Spring {
        /// K, N/m.
        stiffness_n_per_m: f64,
        /// B, N·s/m.
        damping_n_s_per_m: f64,
    },
    /// A damper that never pulls.
    Damper {
        /// B, N·s/m.
        damping_n_s_per_m: f64,
    },
    /// F = C v³ against penetration (KS §4).
    CubicDamper {
        /// C, N·s³/m³.
        coefficient_n_s3_per_m3: f64,
        /// Which form.
        form: CubicForm,
    },
}

/// What renders friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionActuator {
    /// Brakes where there are any, else motors.
    #[default]
    Auto,
    /// Motors.
    Motor,
    /// Brakes, through the brake-direction logic.
    Brake,
}

/// Coulomb friction with stick. Zero coefficients are no friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// μ_s, at least μ_k.
    #[serde(rename = "static")]
    pub static_: f64,
    /// μ_k.
    pub kinetic: f64,
    /// What renders it.
    pub actuator: FrictionActuator,
}

/// One wall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// The front's number for the wall's id: the same wall keeps it from one scene to the next.
    pub key: u64,
    /// What it is made of.
    pub shape: Shape,
    /// How it answers penetration.
    pub law: Law,
    /// Whether passivity control watches it.
    #[serde(default)]
    pub passivity: bool,
    /// Whether brakes may take part.
    #[serde(default = "yes")]
    pub brake: bool,
    /// Friction on its surface.
    #[serde(default)]
    pub friction: Friction,
}

fn yes() -> bool {
    true
}

impl Wall {
    /// A half-space n·x ≤ `offset_m` with a motion law, without friction; brakes may take part.
    #[must_use]
    pub const fn plane(key: u64, normal: Axes, offset_m: f64, eta: f64) -> Self {
        Self {
            key,
            shape: Shape::Plane { normal, offset_m },
            law: Law::Motion { eta },
            passivity: false,
            brake: true,
            friction: Friction {
                static_: 0.0,
                kinetic: 0.0,
                actuator: FrictionActuator::Auto,
            },
        }
    }

    /// A wall that is not there: free space everywhere.
    pub const NONE: Self = Self::plane(0, [0.0, 0.0, 1.0], f64::NEG_INFINITY, 1.0);
}

/// A sine on the set-point of the tip, for the identification of a device whose tip is locked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Unit vector.
    pub direction: Axes,
    /// Amplitude, m.
    pub amplitude_m: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
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
    /// Excitation of the set-point.
    pub probe: Option<Probe>,
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
            probe: None,
            count: 0,
            walls: [Wall::NONE; MAX_WALLS],
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
