//! From the state of the joints to what the scene demands of them: the walls' laws, the brakes'
//! hold, friction, passivity.

pub mod blend;
mod probe;
mod rub;
mod spring_drive;
mod torque_drive;
pub mod touch;
mod walls;

pub use spring_drive::never_stiffer;

use crate::contact::{contact, Contact};
use crate::couple::{dc_stiffness, JointDemand};
use crate::environment::SetPoint;
use crate::estimate::JointState;
use crate::friction::FrictionForce;
use crate::hold::Hold;
use crate::law::Tip;
use crate::layers::Layers;
use crate::linear::V3;
use crate::mapping::workspace_stiffness;
use crate::model::{DeviceModel, DriveModel, KinematicsModel};
use crate::scene::Scene;
use crate::thermal::tuned_residual_ohm;
use rub::Rub;
use spring_drive::Spring;
use touch::Touch;
use walls::{Demanded, Walls};

/// What the scene makes of the present pose.
#[derive(Clone, Copy, Debug)]
pub struct Rendering {
    /// Walls touched in the newest scene.
    pub contact: Contact,
    /// What each wall named in `contact` pushes, N.
    pub touched_force_n: V3,
    /// Where the springs of the scenes want the tip.
    pub set_point: SetPoint,
    /// Tip stiffness of a rigid wall here and now, N/m.
    pub stiffness_n_per_m: f64,
    /// What that asks of the joints.
    pub demand: JointDemand,
    /// Friction on the walls touched, part of the demand.
    pub friction: FrictionForce,
}

/// Renderer of one device.
#[derive(Clone, Debug)]
pub struct Renderer {
    kinematics: KinematicsModel,
    drive: DriveModel,
    /// Smallest bound over the workspace at the tuned resistance, N/m.
    workspace_n_per_m: f64,
    /// On the heap: scenes are too large to be moved about on the stack.
    walls: Box<Walls>,
    hold: Option<Hold>,
    rub: Rub,
}

impl Renderer {
    /// A renderer with an empty scene, called every `period_s`. Searches the workspace: for
    /// start-up, not for the tick.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
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
            walls: Box::new(Walls::new(Tip::new(model, period_s))),
            hold: model.brakes.map(|brakes| Hold::new(&brakes, &model.limits)),
            rub: Rub::new(model, period_s),
        }
    }

    /// Takes a new scene.
    pub fn adopt(&mut self, scene: &Scene) {
        self.walls.layers.adopt(scene);
    }

    /// The scenes in force.
    #[must_use]
    pub fn layers(&self) -> &Layers {
        &self.walls.layers
    }

    /// The walls that pushed in the last tick rendered, those of the newest scene first.
    #[must_use]
    pub fn touches(&self) -> &[Touch] {
        self.walls.touches.as_slice()
    }

    /// Forgets on which side of the walls the tip was.
    pub fn reset(&mut self) {
        self.walls.layers.reset();
    }

    /// Lets `dt_s` of a cross-fade pass.
    pub fn advance(&mut self, dt_s: f64) {
        self.walls.advance(dt_s);
    }

    /// Renders the scenes at `state`, with residual resistances `dr_ohm`, Ω, of a spring drive,
    /// and the measured force of the hand, N, if there is one to be believed.
    #[must_use]
    pub fn render(
        &mut self,
        state: &JointState,
        dr_ohm: &V3,
        hand_force_n: Option<&V3>,
    ) -> Rendering {
        let mut demanded = self.demand_of_walls(state, dr_ohm);
        self.share(&mut demanded, state);
        if let Some(hold) = &self.hold {
            let held = self.walls.touches.as_slice();
            hold.demand(held, state, hand_force_n, &mut demanded.demand);
        }
        let friction = self.rub.demand(
            self.walls.touches.as_slice(),
            self.walls.layers.top().allocation,
            state,
            hand_force_n,
            &mut demanded.demand,
        );
        // Passivity joins here: last, so that the energy of all that is asked for is watched.
        let contact = self.contact(state);
        Rendering {
            contact,
            touched_force_n: V3::from(contact.touched.map(|wall| self.force_of(wall))),
            set_point: demanded.set_point,
            stiffness_n_per_m: demanded.stiffness_n_per_m,
            demand: demanded.demand,
            friction,
        }
    }

    fn contact(&self, state: &JointState) -> Contact {
        let layers = self.layers();
        contact(
            layers.top_facings().as_slice(),
            &state.x,
            &layers.top_proxy(),
        )
    }

    /// What a wall of the newest scene pushes, N.
    fn force_of(&self, wall: usize) -> f64 {
        let scene_wall = self.layers().top().walls().get(wall);
        scene_wall.map_or(0.0, |wall| {
            let of_wall = |touch: &&Touch| touch.push.key == wall.key;
            let touch = self.touches().iter().find(of_wall);
            touch.map_or(0.0, |touch| touch.push.force_n)
        })
    }

    fn demand_of_walls(&mut self, state: &JointState, dr_ohm: &V3) -> Demanded {
        self.walls.touches.clear();
        match &self.drive {
            DriveModel::Spring(drive) => Spring {
                drive: &never_stiffer(drive, dr_ohm),
                dr_ohm,
                kinematics: &self.kinematics,
                workspace_n_per_m: self.workspace_n_per_m,
            }
            .demand(&mut self.walls, state),
            DriveModel::Torque(drive) => torque_drive::demand(&mut self.walls, drive, state),
        }
    }

    /// Settles what each wall pushes, and leaves to the motors what brakes may not share.
    fn share(&mut self, demanded: &mut Demanded, state: &JointState) {
        let touches = &mut self.walls.touches;
        touches.settle(demanded.damper_share);
        demanded.demand.motor_only_nm = if touches.none_shared() {
            demanded.demand.torque_nm
        } else {
            let walls_n = touches.motor_only_n(demanded.damper_share);
            state.jacobian.tr_mul(&(walls_n + demanded.probe_n))
        };
    }
}
