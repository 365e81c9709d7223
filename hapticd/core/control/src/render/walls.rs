//! The scenes in force, their walls, and what those demand before friction and passivity.

use super::blend::Scratch;
use super::touch::Touches;
use crate::couple::JointDemand;
use crate::environment::SetPoint;
use crate::law::Tip;
use crate::layers::Layers;

/// The scenes of one device and the walls its tip touches.
#[derive(Clone, Debug)]
pub struct Walls {
    /// Scenes in force.
    pub layers: Layers,
    /// The tip, as the dampers see it.
    pub tip: Tip,
    /// Walls touched in this tick.
    pub touches: Touches,
    /// Room for the surfaces of one scene.
    pub scratch: Scratch,
}

impl Walls {
    /// The empty scene.
    #[must_use]
    pub fn new(tip: Tip) -> Self {
        Self {
            layers: Layers::new(),
            tip,
            touches: Touches::default(),
            scratch: Scratch::default(),
        }
    }
}

/// What the walls demand.
#[derive(Clone, Copy, Debug)]
pub struct Demanded {
    /// Where their springs want the tip.
    pub set_point: SetPoint,
    /// k_c, N/m.
    pub stiffness_n_per_m: f64,
    /// What that asks of the joints.
    pub demand: JointDemand,
    /// Share of the dampers beside springs at which no wall pulls.
    pub damper_share: f64,
}
