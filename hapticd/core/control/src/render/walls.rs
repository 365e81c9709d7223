//! The scenes in force, their walls, and what those demand before friction and passivity.

use super::blend::Scratch;
use super::probe::excitation;
use super::touch::Touches;
use crate::couple::JointDemand;
use crate::environment::SetPoint;
use crate::law::Tip;
use crate::layers::Layers;
use crate::linear::V3;
use crate::scene::Scene;

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
    /// Time since the start, s.
    t_s: f64,
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
            t_s: 0.0,
        }
    }

    /// Lets `dt_s` pass.
    pub fn advance(&mut self, dt_s: f64) {
        self.t_s += dt_s;
        self.layers.advance(dt_s);
    }

    /// What a scene's probe adds to the set-point now.
    #[must_use]
    pub fn excitation(&self, scene: &Scene) -> SetPoint {
        let probe = scene.probe.as_ref();
        probe.map_or_else(SetPoint::default, |probe| excitation(probe, self.t_s))
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
    /// Force of a probe on a torque drive, N: of the motors alone, and in the demand already.
    pub probe_n: V3,
    /// Share of the dampers beside springs at which no wall pulls.
    pub damper_share: f64,
}
