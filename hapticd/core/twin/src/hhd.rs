//! The hybrid haptic device: motors and particle brakes on a rhombus.

use crate::brake::Brake;
use crate::error::TwinError;
use crate::hand::Hand;
use crate::linkage::RhombusLinkage;
use crate::mechanics::Mechanics;
use crate::model::HhdTwinModel;
use crate::motor::TorqueMotor;
use crate::noise::Noise;
use crate::plant::Plant;
use crate::sensor::{counts, ForceSensor};
use crate::stops::Stops;
use crate::truth::Truth;
use hapticd_control::io::{status, Command, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::{BrakeModel, DeviceModel, DriveModel, JointModel, KinematicsModel};

/// Joints, and coordinates of the tip.
const DOF: usize = 2;

/// Linkage, two motors, two brakes, encoders, force sensor and the operator.
#[derive(Clone, Debug)]
pub struct HhdPlant {
    joints: JointModel,
    rated: BrakeModel,
    substeps: u32,
    period_s: f64,
    mechanics: Mechanics<RhombusLinkage>,
    motors: [TorqueMotor; DOF],
    brakes: [Brake; DOF],
    brake_torque: V3,
    sensor: ForceSensor,
    hand: Hand,
    live: bool,
}

impl HhdPlant {
    /// At rest in the home pose, ticks of `period_s`.
    ///
    /// # Errors
    /// [`TwinError::Mismatch`] when the device is no rhombus with torque drives and brakes.
    pub fn new(
        device: &DeviceModel,
        model: &HhdTwinModel,
        period_s: f64,
    ) -> Result<Self, TwinError> {
        let KinematicsModel::Rhombus { l_m, .. } = device.kinematics else {
            return Err(TwinError::Mismatch("an hhd twin needs rhombus kinematics"));
        };
        let DriveModel::Torque(drive) = &device.drive else {
            return Err(TwinError::Mismatch("an hhd twin needs torque drives"));
        };
        let Some(rated) = device.brakes else {
            return Err(TwinError::Mismatch("an hhd twin needs brakes"));
        };
        let h = period_s / f64::from(model.substeps);
        let linkage = RhombusLinkage::new(&model.linkage, l_m);
        let stops = Stops::new(&model.stops, &device.joints, &device.kinematics);
        let home = V3::from(device.joints.home_rad);
        let mechanics = Mechanics::new(linkage, device.kinematics, &model.friction, stops, home);
        Ok(Self {
            joints: device.joints,
            rated,
            substeps: model.substeps,
            period_s,
            motors: core::array::from_fn(|axis| TorqueMotor::new(drive, &model.motor, axis, h)),
            brakes: core::array::from_fn(|axis| {
                Brake::new(&rated, &model.brake, axis, period_s, h)
            }),
            brake_torque: V3::zeros(),
            sensor: ForceSensor::new(&model.sensor, h),
            hand: Hand::new(&model.hand, mechanics.tip().position, DOF),
            mechanics,
            live: false,
        })
    }

    /// Asks every actuator for this tick's torque; brakes without supply are released.
    fn ask(&mut self, command: &Command) {
        for axis in 0..DOF {
            let (motor_nm, brake_nm) = if command.enable {
                (command.motor_torque_nm[axis], command.brake_torque_nm[axis])
            } else {
                (0.0, 0.0)
            };
            self.motors[axis].ask(motor_nm);
            self.brakes[axis].ask(brake_nm / self.rated.torque_max_nm[axis]);
        }
    }

    fn substep(&mut self, h: f64) {
        let tip = self.mechanics.tip();
        let force = self.hand.step(&tip.position, &tip.velocity, h);
        self.sensor.step(&force);
        let mut motor = V3::zeros();
        let mut brake = V3::zeros();
        for axis in 0..DOF {
            motor[axis] = self.motors[axis].step();
            brake[axis] = self.brakes[axis].step(self.mechanics.q[axis]);
        }
        let torque = motor + tip.jacobian.tr_mul(&force);
        self.brake_torque = self.mechanics.advance(&torque, &brake, h);
    }
}

impl Plant for HhdPlant {
    fn observe(&self, observation: &mut Observation, noise: &mut Noise) {
        let (force, saturated) = self.sensor.read(DOF, noise);
        observation.counts = counts(&self.joints, &self.mechanics.q);
        observation.force_n = force.into();
        observation.status = status::FORCE_PRESENT | status::HOMED;
        if saturated {
            observation.status |= status::SENSOR_SATURATED;
        }
        if self.live {
            observation.status |= status::OUTPUTS_LIVE;
        }
    }

    fn truth(&self) -> Truth {
        let tip = self.mechanics.tip();
        let motor =
            V3::from_fn(|axis, _| self.motors.get(axis).map_or(0.0, TorqueMotor::torque_nm));
        Truth {
            hand_position_m: self.hand.position().into(),
            hand_force_n: self.hand.force().into(),
            joint_position_rad: self.mechanics.q.into(),
            joint_velocity_rad_per_s: self.mechanics.qd.into(),
            tip_position_m: tip.position.into(),
            tip_velocity_m_per_s: tip.velocity.into(),
            motor_current_a: [0.0; 3],
            motor_torque_nm: motor.into(),
            brake_torque_nm: self.brake_torque.into(),
            winding_c: [0.0; 3],
        }
    }

    fn advance(&mut self, command: &Command) {
        self.ask(command);
        let h = self.period_s / f64::from(self.substeps);
        for _ in 0..self.substeps {
            self.substep(h);
        }
        self.live = command.enable;
    }

    fn hand_mut(&mut self) -> &mut Hand {
        &mut self.hand
    }
}
