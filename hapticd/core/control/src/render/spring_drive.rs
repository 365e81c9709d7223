//! Spring drives: springs are set-points of the joints, everything else is volts on top.

use super::blend::{soften, Answers, Blend, Rigid};
use super::walls::{Demanded, Walls};
use crate::couple::{dc_stiffness, spring_demand};
use crate::environment::SetPoint;
use crate::estimate::JointState;
use crate::law::spring::damper_share;
use crate::linear::V3;
use crate::mapping::{isotropic_stiffness, joint_set_point, JointSetPoint};
use crate::model::{KinematicsModel, SpringDriveModel};
use crate::scene::{Scene, StiffnessScope};
use crate::thermal::tuned_residual_ohm;

/// The drive in one tick.
pub struct Spring<'a> {
    /// Gains, never stiffer than tuned.
    pub drive: &'a SpringDriveModel,
    /// Residual resistances, Ω.
    pub dr_ohm: &'a V3,
    /// Geometry.
    pub kinematics: &'a KinematicsModel,
    /// Smallest bound of the stiffness over the workspace, N/m.
    pub workspace_n_per_m: f64,
}

impl Spring<'_> {
    /// What the scenes demand at `state`. They are blended in joint set-points, each with its own
    /// mapping and stiffness: the weights are convex, so that no joint is stiffer than in the
    /// stiffest scene (law 6). A spring is granted at most k_c.
    pub fn demand(&self, walls: &mut Walls, state: &JointState) -> Demanded {
        let k_q = dc_stiffness(self.drive, self.dr_ohm);
        let pose_n_per_m = isotropic_stiffness(&state.jacobian, &k_q);
        let k_c = |scene: &Scene| self.k_c(scene, pose_n_per_m);
        walls.layers.follow(&state.x, |scene, facings| {
            soften(scene, facings, k_c(scene), k_c(scene));
        });
        let mut blend = Blend::default();
        let mut tip = SetPoint::default();
        let mut joints = JointSetPoint::default();
        let mut stiffness_n_per_m = 0.0;
        for layer in walls.layers.weighted() {
            let (weight, scene, _) = layer;
            let answers = self.answers(&walls.tip, state, k_c(scene));
            let excitation = walls.excitation(scene);
            let touches = &mut walls.touches;
            let mut set_point = answers.add(layer, &mut blend, touches, &mut walls.scratch);
            set_point.x_sd += excitation.x_sd;
            set_point.xd_sd += excitation.xd_sd;
            let mapped = joint_set_point(
                scene.mapping,
                self.kinematics,
                state,
                &set_point,
                &k_q,
                k_c(scene),
            );
            tip.x_sd += weight * set_point.x_sd;
            tip.xd_sd += weight * set_point.xd_sd;
            joints.q_sd += weight * mapped.q_sd;
            joints.qd_sd += weight * mapped.qd_sd;
            stiffness_n_per_m += weight * k_c(scene);
        }
        let damper_share = damper_share(&blend.spring_n, &blend.damper_n);
        let mut demand = spring_demand(self.drive, state, &joints, self.dr_ohm);
        let damper_n = damper_share * blend.damper_n + blend.explicit_n;
        demand.add_shared(&state.jacobian, &damper_n);
        Demanded {
            set_point: tip,
            stiffness_n_per_m,
            demand,
            probe_n: V3::zeros(),
            damper_share,
        }
    }

    /// k_c of a scene (WN §V after eq. 29): never above the bound of this pose.
    fn k_c(&self, scene: &Scene, pose_n_per_m: f64) -> f64 {
        match scene.stiffness {
            StiffnessScope::Pose => pose_n_per_m,
            StiffnessScope::Workspace => self.workspace_n_per_m.min(pose_n_per_m),
        }
    }

    /// A rigid wall has no damper of its own: the drive's derivative gain acts on the set-point.
    fn answers<'a>(
        &self,
        tip: &'a crate::law::Tip,
        state: &'a JointState,
        k_c: f64,
    ) -> Answers<'a> {
        Answers {
            state,
            tip,
            rigid: Rigid {
                stiffness_n_per_m: k_c,
                damping_n_s_per_m: 0.0,
            },
            reference_n_per_m: k_c,
        }
    }
}

/// The drive with gains reduced where dR is smaller than tuned: a cold winding would make the
/// joint stiffer by dR₂₅/dR (law 6).
#[must_use]
pub fn never_stiffer(drive: &SpringDriveModel, dr_ohm: &V3) -> SpringDriveModel {
    let tuned = tuned_residual_ohm(drive);
    let mut reduced = *drive;
    for i in 0..3 {
        if dr_ohm[i] < tuned[i] {
            let share = dr_ohm[i] / tuned[i];
            reduced.k_p_v_per_rad[i] *= share;
            reduced.k_d_v_s_per_rad[i] *= share;
        }
    }
    reduced
}
