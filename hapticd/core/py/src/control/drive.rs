use super::{device_model, value_error};
use hapticd_control::couple;
use hapticd_control::estimate::JointState;
use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use hapticd_control::mapping::JointSetPoint;
use hapticd_control::model::{DriveModel, KinematicsModel, SpringDriveModel, TorqueDriveModel};
use pyo3::prelude::*;

/// Spring drives of one device model.
#[pyclass(frozen, module = "hapticd._core")]
pub struct SpringDrive {
    kinematics: KinematicsModel,
    drive: SpringDriveModel,
}

#[pymethods]
impl SpringDrive {
    #[new]
    fn new(device_json: &str) -> PyResult<Self> {
        let model = device_model(device_json)?;
        match model.drive {
            DriveModel::Spring(drive) => Ok(Self {
                kinematics: model.kinematics,
                drive,
            }),
            DriveModel::Torque(_) => Err(value_error("the device has torque drives")),
        }
    }

    /// Static joint torque, tip force and e_W.
    #[pyo3(signature = (*, q, qd, q_sd, qd_sd, dr_ohm))]
    fn demand(&self, q: Axes, qd: Axes, q_sd: Axes, qd_sd: Axes, dr_ohm: Axes) -> [Axes; 3] {
        let state = JointState::at(&self.kinematics, q.into(), qd.into());
        let set_point = JointSetPoint {
            q_sd: q_sd.into(),
            qd_sd: qd_sd.into(),
        };
        let demand = couple::spring_demand(&self.drive, &state, &set_point, &dr_ohm.into());
        [demand.torque_nm, demand.force_n, demand.motor_v].map(Axes::from)
    }

    fn dc_stiffness(&self, dr_ohm: Axes) -> Axes {
        couple::dc_stiffness(&self.drive, &V3::from(dr_ohm)).into()
    }
}

/// Torque drives of one device model, behind their virtual coupling.
#[pyclass(frozen, module = "hapticd._core")]
pub struct TorqueDrive {
    kinematics: KinematicsModel,
    drive: TorqueDriveModel,
}

#[pymethods]
impl TorqueDrive {
    #[new]
    fn new(device_json: &str) -> PyResult<Self> {
        let model = device_model(device_json)?;
        match model.drive {
            DriveModel::Torque(drive) => Ok(Self {
                kinematics: model.kinematics,
                drive,
            }),
            DriveModel::Spring(_) => Err(value_error("the device has spring drives")),
        }
    }

    /// Joint torque and tip force.
    #[pyo3(signature = (*, q, qd, x_sd, xd_sd))]
    fn demand(&self, q: Axes, qd: Axes, x_sd: Axes, xd_sd: Axes) -> [Axes; 2] {
        let state = JointState::at(&self.kinematics, q.into(), qd.into());
        let spring_n = self.drive.stiffness_n_per_m * (V3::from(x_sd) - state.x);
        let damper_n = self.drive.damping_n_s_per_m * (V3::from(xd_sd) - state.xd);
        let demand = couple::torque_demand(&state.jacobian, &spring_n, &damper_n);
        [demand.torque_nm, demand.force_n].map(Axes::from)
    }
}
