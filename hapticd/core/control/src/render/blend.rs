//! The scenes in force as one demand: each answered by itself, blended by weights that are not
//! negative and sum to one, so that no blend is stiffer than its stiffest scene.

use super::touch::{Surface, Touch, Touches, FORCE_MIN_N};
use crate::damping::{against_penetration, passed, Linear};
use crate::environment::{set_point, shares, SetPoint};
use crate::estimate::JointState;
use crate::facing::{Facing, Facings, MAX_FACINGS};
use crate::law::{damper_force, damping, eta, exists, stiffness, Push, Tip};
use crate::linear::V3;
use crate::scene::{Scene, Wall};

/// What a rigid motion wall is on the drive at hand.
#[derive(Clone, Copy, Debug)]
pub struct Rigid {
    /// Stiffness, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping, N·s/m.
    pub damping_n_s_per_m: f64,
}

/// One scene with its weight and the surfaces that face the tip.
pub type Layer<'a> = (f64, &'a Scene, &'a Facings);

/// Tip forces of the scenes, N.
#[derive(Clone, Copy, Debug, Default)]
pub struct Blend {
    /// Of all springs: K_ref (z − x) of the Moreau envelope.
    pub spring_n: V3,
    /// Of the dampers beside springs.
    pub damper_n: V3,
    /// Of the walls without spring.
    pub explicit_n: V3,
}

/// Room for the surfaces of one scene.
#[derive(Clone, Debug)]
pub struct Scratch {
    dampers: Facings,
    spring_m: [f64; MAX_FACINGS],
    damper_m_per_s: [f64; MAX_FACINGS],
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            dampers: Facings::default(),
            spring_m: [0.0; MAX_FACINGS],
            damper_m_per_s: [0.0; MAX_FACINGS],
        }
    }
}

/// Answers of the walls of one scene.
pub struct Answers<'a> {
    /// The tip.
    pub state: &'a JointState,
    /// As the dampers see it.
    pub tip: &'a Tip,
    /// What a rigid motion wall is.
    pub rigid: Rigid,
    /// K_ref: what the surfaces' η refer to, N/m.
    pub reference_n_per_m: f64,
}

impl Answers<'_> {
    /// Adds the scene's forces to `blend` and its walls' pushes to `touches`; gives the tip's
    /// set-point among its springs. `scratch` is overwritten.
    pub fn add(
        &self,
        layer: Layer<'_>,
        blend: &mut Blend,
        touches: &mut Touches,
        scratch: &mut Scratch,
    ) -> SetPoint {
        let (weight, scene, facings) = layer;
        let state = self.state;
        let springs = set_point(facings.as_slice(), &state.x, &state.xd);
        let linear = self.linear(scene, facings, &springs.x_sd);
        let (hardest, u) = self.one_sided(scene, facings, &mut scratch.dampers);
        blend.spring_n += weight * self.reference_n_per_m * (springs.x_sd - state.x);
        blend.damper_n += weight * linear.force_n(&state.xd);
        blend.explicit_n += weight * hardest * (u.x_sd - state.xd);
        shares(facings.as_slice(), &springs, &mut scratch.spring_m);
        shares(scratch.dampers.as_slice(), &u, &mut scratch.damper_m_per_s);
        touches.begin();
        let mut before = None;
        for (index, facing) in facings.as_slice().iter().enumerate() {
            let wall = &scene.walls()[facing.wall];
            let surface = Surface {
                spring_n: self.reference_n_per_m * scratch.spring_m[index],
                damper_n: self.linear_part_n(&linear, wall, facing, &springs.x_sd),
                explicit_n: hardest * scratch.damper_m_per_s[index],
            };
            if let Some(touch) = self.touch(index, facing, wall, &surface, touches) {
                touch.parts.add(weight, &facing.normal.into(), &surface);
                if before != Some(facing.wall) {
                    touch.weigh(weight, wall);
                }
                before = Some(facing.wall);
            }
        }
        springs
    }

    /// The dampers beside the springs that push.
    fn linear(&self, scene: &Scene, facings: &Facings, z: &V3) -> Linear {
        let damping = |facing: &Facing| self.damping(&scene.walls()[facing.wall], facing, z);
        let all = facings.as_slice();
        let mut linear = Linear::new(all.iter().map(damping).fold(0.0, f64::max));
        for facing in all {
            linear.add(&facing.normal.into(), damping(facing));
        }
        linear
    }

    fn linear_part_n(&self, linear: &Linear, wall: &Wall, facing: &Facing, z: &V3) -> f64 {
        let damping = self.damping(wall, facing, z);
        linear.part_n(&facing.normal.into(), damping, &self.state.xd)
    }

    /// B of a wall, N·s/m, none where its spring does not push at the set-point `z`.
    fn damping(&self, wall: &Wall, facing: &Facing, z: &V3) -> f64 {
        if facing.depth_m(z) > 0.0 && facing.eta < 1.0 {
            damping(&wall.law, self.rigid.damping_n_s_per_m)
        } else {
            0.0
        }
    }

    /// The walls without spring: the hardest of them now, N·s/m, and the velocity they let pass.
    /// `dampers` becomes their surfaces, one for each of `facings`.
    fn one_sided(
        &self,
        scene: &Scene,
        facings: &Facings,
        dampers: &mut Facings,
    ) -> (f64, SetPoint) {
        let secant = |facing: &Facing| self.secant(&scene.walls()[facing.wall], facing);
        let all = facings.as_slice();
        let hardest = all.iter().map(secant).fold(0.0, f64::max);
        dampers.clear();
        for facing in all {
            let damping = secant(facing);
            let beta = if damping > 0.0 {
                damping / hardest
            } else {
                0.0
            };
            dampers.push(against_penetration(facing, beta));
        }
        (hardest, passed(dampers.as_slice(), &self.state.xd))
    }

    /// F/v of a wall without spring that the tip goes into, N·s/m.
    fn secant(&self, wall: &Wall, facing: &Facing) -> f64 {
        let closing = -V3::from(facing.normal).dot(&self.state.xd);
        if closing > 0.0 && facing.depth_m(&self.state.x) > 0.0 {
            damper_force(&wall.law, closing, self.tip) / closing
        } else {
            0.0
        }
    }

    /// The entry of a wall that the tip is in, or that its set-point is pushed into.
    fn touch<'t>(
        &self,
        index: usize,
        facing: &Facing,
        wall: &Wall,
        surface: &Surface,
        touches: &'t mut Touches,
    ) -> Option<&'t mut Touch> {
        let depth_m = facing.depth_m(&self.state.x);
        let push = Push {
            facing: index,
            wall: facing.wall,
            key: wall.key,
            normal: facing.normal.into(),
            depth_m,
            force_n: 0.0,
        };
        let touched = depth_m > 0.0 || surface.spring_n > FORCE_MIN_N;
        if touched && exists(&wall.law) {
            touches.entry(&Touch::of(wall, push))
        } else {
            None
        }
    }
}

/// K_ref, N/m: the stiffest wall of the scene, touched or not, at least a rigid one. Were it that
/// of the walls touched, a wall that comes within reach would change the others' envelope.
#[must_use]
pub fn reference_n_per_m(scene: &Scene, rigid_n_per_m: f64) -> f64 {
    let laws = scene.walls().iter().map(|wall| &wall.law);
    laws.map(|law| stiffness(law, rigid_n_per_m))
        .fold(rigid_n_per_m, f64::max)
}

/// Fills in how much of a penetration each surface lets pass.
pub fn soften(scene: &Scene, facings: &mut Facings, rigid_n_per_m: f64, reference_n_per_m: f64) {
    for facing in facings.as_mut_slice() {
        let law = &scene.walls()[facing.wall].law;
        facing.eta = eta(law, rigid_n_per_m, reference_n_per_m);
    }
}
