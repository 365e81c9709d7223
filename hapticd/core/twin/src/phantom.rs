//! The PHANTOM 1.0 on spring drives.

use crate::error::TwinError;
use crate::hand::Hand;
use crate::linkage::PhantomLinkage;
use crate::mechanics::Mechanics;
use crate::model::PhantomTwinModel;
use crate::noise::Noise;
use crate::plant::Plant;
use crate::sensor::counts;
use crate::stops::Stops;
use crate::truth::Truth;
use crate::winding::Winding;
use hapticd_control::io::{status, Command, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::{DeviceModel, DriveModel, JointModel, KinematicsModel};

/// Linkage, three windings with their amplifiers, encoders and the operator.
#[derive(Clone, Debug)]
pub struct PhantomPlant {
    joints: JointModel,
    ratio: V3,
    substeps: u32,
    period_s: f64,
    mechanics: Mechanics<PhantomLinkage>,
    windings: [Winding; 3],
    hand: Hand,
    live: bool,
}

impl PhantomPlant {
    /// At rest in the home pose, ticks of `period_s`.
    ///
    /// # Errors
    /// [`TwinError::Mismatch`] when the device is no PHANTOM on spring drives.
    pub fn new(
        device: &DeviceModel,
        model: &PhantomTwinModel,
        period_s: f64,
    ) -> Result<Self, TwinError> {
        let KinematicsModel::Phantom { l1_m, l2_m, .. } = device.kinematics else {
            return Err(TwinError::Mismatch(
                "a phantom twin needs phantom kinematics",
            ));
        };
        let DriveModel::Spring(drive) = &device.drive else {
            return Err(TwinError::Mismatch("a phantom twin needs spring drives"));
        };
        let linkage = PhantomLinkage::new(
            &model.linkage,
            l1_m,
            l2_m,
            &drive.ratio,
            model.winding.rotor_kg_m2,
        );
        let stops = Stops::new(&model.stops, &device.joints, &device.kinematics);
        let home = V3::from(device.joints.home_rad);
        let mechanics = Mechanics::new(linkage, device.kinematics, &model.friction, stops, home);
        Ok(Self {
            joints: device.joints,
            ratio: V3::from(drive.ratio),
            substeps: model.substeps,
            period_s,
            windings: core::array::from_fn(|axis| Winding::new(drive, &model.winding, axis)),
            hand: Hand::new(&model.hand, mechanics.tip().position, device.dof),
            mechanics,
            live: false,
        })
    }

    /// Joint torques of the motors after one step of `h` (s), N·m.
    fn drive(&mut self, command: &Command, h: f64) -> V3 {
        let (theta, omega) = (
            self.ratio.component_mul(&self.mechanics.q),
            self.ratio.component_mul(&self.mechanics.qd),
        );
        let mut torque = V3::zeros();
        for (axis, winding) in self.windings.iter_mut().enumerate() {
            torque[axis] = self.ratio[axis]
                * if command.enable {
                    winding.drive(command.motor_v[axis], theta[axis], omega[axis], h)
                } else {
                    winding.release(theta[axis], h)
                };
        }
        torque
    }
}

impl Plant for PhantomPlant {
    fn observe(&self, observation: &mut Observation, _noise: &mut Noise) {
        observation.counts = counts(&self.joints, &self.mechanics.q);
        observation.motor_current_a = core::array::from_fn(|axis| self.windings[axis].current_a);
        observation.status = status::CURRENT_PRESENT | status::HOMED;
        if self.live {
            observation.status |= status::OUTPUTS_LIVE;
        }
    }

    fn truth(&self) -> Truth {
        let tip = self.mechanics.tip();
        let torque = V3::from_fn(|axis, _| self.ratio[axis] * self.windings[axis].torque_nm());
        Truth {
            hand_position_m: self.hand.position().into(),
            hand_force_n: self.hand.force().into(),
            joint_position_rad: self.mechanics.q.into(),
            joint_velocity_rad_per_s: self.mechanics.qd.into(),
            tip_position_m: tip.position.into(),
            tip_velocity_m_per_s: tip.velocity.into(),
            motor_current_a: core::array::from_fn(|axis| self.windings[axis].current_a),
            motor_torque_nm: torque.into(),
            brake_torque_nm: [0.0; 3],
            winding_c: core::array::from_fn(|axis| self.windings[axis].winding_c),
        }
    }

    fn advance(&mut self, command: &Command) {
        let h = self.period_s / f64::from(self.substeps);
        for _ in 0..self.substeps {
            let tip = self.mechanics.tip();
            let force = self.hand.step(&tip.position, &tip.velocity, h);
            let torque = self.drive(command, h) + tip.jacobian.tr_mul(&force);
            self.mechanics.advance(&torque, &V3::zeros(), h);
        }
        for winding in &mut self.windings {
            winding.heat(self.period_s);
        }
        self.live = command.enable;
    }

    fn hand_mut(&mut self) -> &mut Hand {
        &mut self.hand
    }
}
