//! From the state of the joints to what the scene demands of them.

use crate::contact::{contact, Contact};
use crate::couple::{dc_stiffness, spring_demand, torque_demand, JointDemand};
use crate::environment::{set_point, SetPoint};
use crate::estimate::JointState;
use crate::facing::Facings;
use crate::law::eta;
use crate::layers::Layers;
use crate::linear::V3;
use crate::mapping::{isotropic_stiffness, joint_set_point, workspace_stiffness, JointSetPoint};
use crate::model::{DeviceModel, DriveModel, KinematicsModel, SpringDriveModel, TorqueDriveModel};
use crate::scene::{Scene, StiffnessScope};
use crate::thermal::tuned_residual_ohm;

/// What the scene makes of the present pose.
#[derive(Clone, Copy, Debug)]
pub struct Rendering {
    /// Walls touched in the newest scene.
    pub contact: Contact,
    /// Where the scenes want the tip.
    pub set_point: SetPoint,
    /// Tip stiffness of a rigid wall here and now, N/m.
    pub stiffness_n_per_m: f64,
    /// What that asks of the joints.
    pub demand: JointDemand,
}

/// Renderer of one device.
#[derive(Clone, Debug)]
pub struct Renderer {
    kinematics: KinematicsModel,
    drive: DriveModel,
    /// Smallest bound over the workspace at the tuned resistance, N/m.
    workspace_n_per_m: f64,
    layers: Layers,
}

impl Renderer {
    /// A renderer with an empty scene. Searches the workspace: for start-up, not for the tick.
    #[must_use]
    pub fn new(model: &DeviceModel) -> Self {
        let workspace_n_per_m = match &model.drive {
            DriveModel::Spring(drive) => {
                workspace_stiffness(model, &dc_stiffness(drive, &tuned_residual_ohm(drive)))
            }
            DriveModel::Torque(drive) => drive.stiffness_n_per_m,
        };
        Self {
            kinematics: model.kinematics,
            drive: model.drive,
            workspace_n_per_m,
            layers: Layers::new(),
        }
    }

    /// Takes a new scene.
    pub fn adopt(&mut self, scene: &Scene) {
        self.layers.adopt(scene);
    }

    /// The scenes in force.
    #[must_use]
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    /// Lets `dt_s` of a cross-fade pass.
    pub fn advance(&mut self, dt_s: f64) {
        self.layers.advance(dt_s);
    }

    /// Renders the scenes at `state`, with residual resistances `dr_ohm`, Ω, of a spring drive.
    #[must_use]
    pub fn render(&mut self, state: &JointState, dr_ohm: &V3) -> Rendering {
        match self.drive {
            DriveModel::Spring(drive) => self.spring(&never_stiffer(&drive, dr_ohm), state, dr_ohm),
            DriveModel::Torque(drive) => self.torque(&drive, state),
        }
    }

    /// Scenes are blended in joint set-points, each with its own mapping and stiffness: the
    /// weights are convex, so that no joint is stiffer than in the stiffest scene (law 6).
    fn spring(&mut self, drive: &SpringDriveModel, state: &JointState, dr_ohm: &V3) -> Rendering {
        let k_q = dc_stiffness(drive, dr_ohm);
        let pose_n_per_m = isotropic_stiffness(&state.jacobian, &k_q);
        let workspace_n_per_m = self.workspace_n_per_m;
        self.layers.follow(&state.x, |scene, facings| {
            soften(scene, facings, k_c(scene, workspace_n_per_m, pose_n_per_m));
        });
        let mut tip = Blend::default();
        let mut joints = JointSetPoint::default();
        let mut stiffness_n_per_m = 0.0;
        for (weight, scene, facings) in self.layers.weighted() {
            let k_c = k_c(scene, workspace_n_per_m, pose_n_per_m);
            let set_point = set_point(facings.as_slice(), &state.x, &state.xd);
            let mapped = joint_set_point(
                scene.mapping,
                &self.kinematics,
                state,
                &set_point,
                &k_q,
                k_c,
            );
            tip.add(weight, &set_point);
            joints.q_sd += weight * mapped.q_sd;
            joints.qd_sd += weight * mapped.qd_sd;
            stiffness_n_per_m += weight * k_c;
        }
        Rendering {
            contact: self.contact(state),
            set_point: tip.0,
            stiffness_n_per_m,
            demand: spring_demand(drive, state, &joints, dr_ohm),
        }
    }

    fn torque(&mut self, drive: &TorqueDriveModel, state: &JointState) -> Rendering {
        self.layers.follow(&state.x, |scene, facings| {
            soften(scene, facings, drive.stiffness_n_per_m);
        });
        let mut tip = Blend::default();
        for (weight, _, facings) in self.layers.weighted() {
            tip.add(weight, &set_point(facings.as_slice(), &state.x, &state.xd));
        }
        Rendering {
            contact: self.contact(state),
            set_point: tip.0,
            stiffness_n_per_m: drive.stiffness_n_per_m,
            demand: torque_demand(drive, state, &tip.0.x_sd, &tip.0.xd_sd),
        }
    }

    fn contact(&self, state: &JointState) -> Contact {
        contact(self.layers.top_facings().as_slice(), &state.x)
    }
}

/// k_c of a scene (WN §V after eq. 29): never above the bound of this pose.
fn k_c(scene: &Scene, workspace_n_per_m: f64, pose_n_per_m: f64) -> f64 {
    match scene.stiffness {
        StiffnessScope::Pose => pose_n_per_m,
        StiffnessScope::Workspace => workspace_n_per_m.min(pose_n_per_m),
    }
}

fn soften(scene: &Scene, facings: &mut Facings, k_c: f64) {
    for facing in facings.as_mut_slice() {
        facing.eta = eta(&scene.walls()[facing.wall].law, k_c);
    }
}

#[derive(Clone, Copy, Default)]
struct Blend(SetPoint);

impl Blend {
    fn add(&mut self, weight: f64, set_point: &SetPoint) {
        self.0.x_sd += weight * set_point.x_sd;
        self.0.xd_sd += weight * set_point.xd_sd;
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
