//! The shipped device models, and random poses inside their limits.

use hapticd_control::linear::V3;
use hapticd_control::model::{DeviceModel, DriveModel, SpringDriveModel, TorqueDriveModel};
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

/// A pose inside every limit.
pub fn pose(model: &DeviceModel) -> impl Strategy<Value = V3> {
    let (kinematics, joints) = (model.kinematics, model.joints);
    let fractions = prop::array::uniform3(0.0..1.0_f64);
    fractions.prop_filter_map("coupled joints leave no room", move |at| {
        let blend = |i: usize, low: f64, high: f64| low + (high - low) * at[i];
        let mut q = V3::from_fn(|i, _| blend(i, joints.min_rad[i], joints.max_rad[i]));
        let pair = kinematics.coupling();
        let low = joints.min_rad[pair.to].max(q[pair.from] + pair.min_rad);
        let high = joints.max_rad[pair.to].min(q[pair.from] + pair.max_rad);
        q[pair.to] = blend(pair.to, low, high);
        (low < high).then_some(q)
    })
}

/// Either device with a pose of its own.
pub fn device_and_pose() -> impl Strategy<Value = (DeviceModel, V3)> {
    prop_oneof![Just(phantom()), Just(hhd())].prop_flat_map(|model| {
        let pose = pose(&model);
        (Just(model), pose)
    })
}

/// A vector with entries in ±`size`, its third entry zero for a two-joint device.
pub fn vector(dof: usize, size: f64) -> impl Strategy<Value = V3> {
    prop::array::uniform3(-size..size)
        .prop_map(move |entries| V3::from_fn(|i, _| if i < dof { entries[i] } else { 0.0 }))
}
