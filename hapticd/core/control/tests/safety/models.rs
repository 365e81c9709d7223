//! The shipped device models, and random variations of them.

use hapticd_control::model::{
    BrakeModel, DeviceModel, DriveModel, LimitModel, SpringDriveModel, TorqueDriveModel,
};
use proptest::prelude::*;

fn parse(text: &str) -> DeviceModel {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    table.remove("twin");
    table.try_into().expect("device file matches the model")
}

pub fn phantom() -> DeviceModel {
    parse(include_str!("../../../../devices/phantom-1.0.toml"))
}

pub fn hhd() -> DeviceModel {
    parse(include_str!("../../../../devices/hhd.toml"))
}

pub fn brakes() -> BrakeModel {
    hhd().brakes.expect("the HHD has brakes")
}

pub fn spring_drive() -> SpringDriveModel {
    match phantom().drive {
        DriveModel::Spring(drive) => drive,
        DriveModel::Torque(_) => unreachable!("the PHANTOM has spring drives"),
    }
}

pub fn torque_drive() -> TorqueDriveModel {
    match hhd().drive {
        DriveModel::Torque(drive) => drive,
        DriveModel::Spring(_) => unreachable!("the HHD has torque drives"),
    }
}

/// Either device with its gains, limits and actuators scaled at random.
pub fn any_model() -> impl Strategy<Value = DeviceModel> {
    let scale = || 0.3..3.0_f64;
    let scales = (scale(), scale(), scale(), scale(), scale());
    (any::<bool>(), scales, any::<bool>()).prop_map(|(spatial, scales, release)| {
        let mut model = if spatial { phantom() } else { hhd() };
        vary_limits(&mut model.limits, scales);
        vary_drive(&mut model.drive, scales.4);
        if let Some(brakes) = &mut model.brakes {
            brakes.lag_s *= scales.2;
            brakes.release_on_stop = release;
        }
        model
    })
}

fn vary_limits(limits: &mut LimitModel, scales: (f64, f64, f64, f64, f64)) {
    limits.tip_force_n *= scales.0;
    limits.tip_slew_n_per_s *= 0.1 * scales.1;
    limits.brake_slew_nm_per_s *= scales.1;
    limits.fade_s *= scales.2;
    limits.ramp_s *= scales.3;
}

fn vary_drive(drive: &mut DriveModel, scale: f64) {
    match drive {
        DriveModel::Spring(drive) => {
            drive.k_p_v_per_rad = drive.k_p_v_per_rad.map(|k_p| k_p * scale);
            drive.current_max_a = drive.current_max_a.map(|max| max * scale);
            drive.voltage_max_v = drive.voltage_max_v.map(|max| max * scale);
        }
        DriveModel::Torque(drive) => {
            drive.stiffness_n_per_m *= scale;
            drive.lag_s *= scale;
            drive.torque_max_nm = drive.torque_max_nm.map(|max| max * (0.9 * scale).max(0.6));
        }
    }
}
