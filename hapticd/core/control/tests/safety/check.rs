//! Models that cannot be driven are refused at the start, by name.

use crate::models::{hhd, phantom};
use crate::rig::RATE_HZ;
use hapticd_control::check::check;
use hapticd_control::controller::Controller;
use hapticd_control::model::{
    BrakeModel, DeviceModel, DriveModel, KinematicsModel, SpringDriveModel, TorqueDriveModel,
};

fn key(model: &DeviceModel) -> Option<&'static str> {
    check(model, RATE_HZ).err().map(|error| error.key)
}

#[test]
fn shipped_models_are_sound() {
    assert_eq!(key(&phantom()), None);
    assert_eq!(key(&hhd()), None);
}

#[test]
fn rate_must_be_positive() {
    for rate_hz in [0.0, -1000.0, f64::NAN, f64::INFINITY] {
        let error = Controller::new(&hhd(), rate_hz).expect_err("rate is not usable");
        assert_eq!(error.key, "rate_hz");
        assert!(error.to_string().starts_with("rate_hz must be positive"));
    }
}

type Spoil = fn(&mut DeviceModel);

/// Breaks one value of a model and expects its key.
fn refused(base: fn() -> DeviceModel, cases: &[(&str, Spoil)]) {
    for (expected, spoil) in cases {
        let mut model = base();
        spoil(&mut model);
        assert_eq!(key(&model), Some(*expected));
    }
}

#[test]
fn geometry_and_joints_are_checked() {
    refused(
        hhd,
        &[
            ("dof", |model| model.dof = 1),
            ("dof", |model| model.dof = 4),
            ("dof", |model| model.dof = 3),
            ("kinematics.l_m", |model| {
                model.kinematics = rhombus(0.0, 0.7, 2.7);
            }),
            ("kinematics", |model| {
                model.kinematics = rhombus(0.2, 2.7, 0.7);
            }),
            ("joints.counts_per_rad", |model| {
                model.joints.counts_per_rad[1] = 0.0
            }),
            ("joints.counts_per_rad", |model| {
                model.joints.counts_per_rad[0] = f64::INFINITY;
            }),
            ("joints.zero_rad", |model| {
                model.joints.zero_rad[0] = f64::NAN
            }),
            ("joints.max_rad", |model| model.joints.max_rad[0] = -0.698),
            ("joints.max_rad", |model| model.joints.max_rad[1] = f64::NAN),
            ("estimator.lambda_rad_per_s", |model| {
                model.estimator.lambda_rad_per_s = 0.0;
            }),
        ],
    );
    refused(
        phantom,
        &[
            ("dof", |model| model.dof = 2),
            ("kinematics.l1_m", |model| model.kinematics = arm(0.0, 0.14)),
            ("kinematics.l2_m", |model| {
                model.kinematics = arm(0.14, -0.14)
            }),
        ],
    );
}

fn rhombus(l_m: f64, opening_min_rad: f64, opening_max_rad: f64) -> KinematicsModel {
    KinematicsModel::Rhombus {
        l_m,
        opening_min_rad,
        opening_max_rad,
    }
}

fn arm(l1_m: f64, l2_m: f64) -> KinematicsModel {
    KinematicsModel::Phantom {
        l1_m,
        l2_m,
        coupling_min_rad: -1.0,
        coupling_max_rad: 1.0,
    }
}

fn spring(model: &mut DeviceModel) -> &mut SpringDriveModel {
    match &mut model.drive {
        DriveModel::Spring(drive) => drive,
        DriveModel::Torque(_) => unreachable!("the PHANTOM has spring drives"),
    }
}

#[test]
fn spring_drives_are_checked() {
    refused(
        phantom,
        &[
            ("drive.ratio", |model| spring(model).ratio[2] = 0.0),
            ("drive.k_t_nm_per_a", |model| {
                spring(model).k_t_nm_per_a[0] = -0.1
            }),
            ("drive.l_h", |model| spring(model).l_h[1] = 0.0),
            ("drive.r_hat_ohm", |model| spring(model).r_hat_ohm[1] = 0.0),
            ("drive.r_hat_ohm", |model| spring(model).r_hat_ohm[1] = 2.18),
            ("drive.k_p_v_per_rad", |model| {
                spring(model).k_p_v_per_rad[0] = 0.0
            }),
            ("drive.k_d_v_s_per_rad", |model| {
                spring(model).k_d_v_s_per_rad[0] = -0.1
            }),
            ("drive.voltage_max_v", |model| {
                spring(model).voltage_max_v[0] = 0.0
            }),
            ("drive.current_continuous_a", |model| {
                spring(model).current_continuous_a[0] = 0.0;
            }),
            ("drive.current_max_a", |model| {
                spring(model).current_max_a[2] = 1.24
            }),
            ("drive.peak_time_s", |model| spring(model).peak_time_s = 0.0),
            ("drive.thermal.winding_case_k_per_w", |model| {
                spring(model).thermal.winding_case_k_per_w = 0.0;
            }),
            ("drive.thermal.case_ambient_k_per_w", |model| {
                spring(model).thermal.case_ambient_k_per_w = 0.0;
            }),
            ("drive.thermal.winding_s", |model| {
                spring(model).thermal.winding_s = 0.0
            }),
            ("drive.thermal.case_s", |model| {
                spring(model).thermal.case_s = 0.0
            }),
            ("drive.thermal.winding_max_c", |model| {
                spring(model).thermal.winding_max_c = 25.0;
            }),
        ],
    );
}

fn torque(model: &mut DeviceModel) -> &mut TorqueDriveModel {
    match &mut model.drive {
        DriveModel::Torque(drive) => drive,
        DriveModel::Spring(_) => unreachable!("the HHD has torque drives"),
    }
}

fn brake(model: &mut DeviceModel) -> &mut BrakeModel {
    model.brakes.as_mut().expect("the HHD has brakes")
}

#[test]
fn torque_drives_and_brakes_are_checked() {
    refused(
        hhd,
        &[
            ("drive.torque_continuous_nm", |model| {
                torque(model).torque_continuous_nm[0] = 0.0;
            }),
            ("drive.torque_max_nm", |model| {
                torque(model).torque_max_nm[1] = 11.1
            }),
            ("drive.peak_time_s", |model| {
                torque(model).peak_time_s = f64::NAN
            }),
            ("drive.lag_s", |model| torque(model).lag_s = -0.1),
            ("drive.stiffness_n_per_m", |model| {
                torque(model).stiffness_n_per_m = 0.0
            }),
            ("drive.damping_n_s_per_m", |model| {
                torque(model).damping_n_s_per_m = -1.0
            }),
            ("brakes.torque_max_nm", |model| {
                brake(model).torque_max_nm[0] = 0.0
            }),
            ("brakes.drag_nm", |model| brake(model).drag_nm[0] = -0.1),
            ("brakes.lag_s", |model| brake(model).lag_s = -0.1),
            ("brakes.dead_time_s", |model| {
                brake(model).dead_time_s = -0.1
            }),
            ("brakes.dead_time_s", |model| {
                brake(model).dead_time_s = 11.0
            }),
            ("brakes.hysteresis", |model| brake(model).hysteresis = -0.1),
            ("brakes.omega_off_rad_per_s", |model| {
                brake(model).omega_off_rad_per_s = 0.0;
            }),
            ("brakes.omega_on_rad_per_s", |model| {
                brake(model).omega_on_rad_per_s = 0.02;
            }),
            ("brakes.hand_torque_min_nm", |model| {
                brake(model).hand_torque_min_nm = -0.1;
            }),
        ],
    );
}

#[test]
fn limits_are_checked() {
    refused(
        hhd,
        &[
            ("limits.tip_force_n", |model| model.limits.tip_force_n = 0.0),
            ("limits.tip_slew_n_per_s", |model| {
                model.limits.tip_slew_n_per_s = 0.0
            }),
            ("limits.brake_slew_nm_per_s", |model| {
                model.limits.brake_slew_nm_per_s = 0.0;
            }),
            ("limits.brake_slew_nm_per_s", |model| {
                model.limits.brake_slew_nm_per_s = -1.0;
            }),
            ("limits.tip_speed_m_per_s", |model| {
                model.limits.tip_speed_m_per_s = 0.0
            }),
            ("limits.joint_jump_rad", |model| {
                model.limits.joint_jump_rad = 0.0
            }),
            ("limits.joint_margin_rad", |model| {
                model.limits.joint_margin_rad = -0.1
            }),
            ("limits.singularity_margin", |model| {
                model.limits.singularity_margin = 0.0
            }),
            ("limits.singularity_margin", |model| {
                model.limits.singularity_margin = 1.0
            }),
            ("limits.sensor_force_n", |model| {
                model.limits.sensor_force_n = -1.0
            }),
            ("limits.sensor_age_s", |model| {
                model.limits.sensor_age_s = -1.0
            }),
            ("limits.missing_ticks", |model| {
                model.limits.missing_ticks = 0
            }),
            ("limits.late_ticks", |model| model.limits.late_ticks = 0),
            ("limits.delay_spare_ticks", |model| {
                model.limits.delay_spare_ticks = 3
            }),
            ("limits.ramp_s", |model| model.limits.ramp_s = 0.0),
            ("limits.fade_s", |model| model.limits.fade_s = 0.0),
            ("limits.heartbeat_s", |model| model.limits.heartbeat_s = 0.0),
        ],
    );
}
