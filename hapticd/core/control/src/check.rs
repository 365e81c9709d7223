//! Start-up check of a device model: what the loop relies on holds before the first tick.

use crate::energy::{DELAYS, EXCHANGE_TICKS};
use crate::io::{Axes, AXES};
use crate::model::{
    BrakeModel, DeviceModel, DriveModel, JointModel, KinematicsModel, LimitModel, SpringDriveModel,
    TorqueDriveModel,
};
use core::fmt;

/// A value of a device model that the loop cannot work with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelError {
    /// Dotted key as in the model's file, e.g. `limits.tip_force_n`.
    pub key: &'static str,
    /// What must hold.
    pub rule: &'static str,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.key, self.rule)
    }
}

impl std::error::Error for ModelError {}

const POSITIVE: &str = "must be positive and finite";
const NOT_NEGATIVE: &str = "must be finite and not negative";

type Checked = Result<(), ModelError>;

/// Checks every value of `model` and the rate at which it is to be driven.
///
/// # Errors
/// The first key that breaks its rule.
pub fn check(model: &DeviceModel, rate_hz: f64) -> Checked {
    require((2..=AXES).contains(&model.dof), "dof", "must be 2 or 3")?;
    positive("rate_hz", rate_hz)?;
    let axes = Active(model.dof);
    kinematics(&model.kinematics, model.dof)?;
    joints(&model.joints, axes)?;
    positive("tip.mass_kg", model.tip.mass_kg)?;
    positive(
        "estimator.lambda_rad_per_s",
        model.estimator.lambda_rad_per_s,
    )?;
    match &model.drive {
        DriveModel::Spring(drive) => spring(drive, axes)?,
        DriveModel::Torque(drive) => torque(drive, axes)?,
    }
    if let Some(model) = &model.brakes {
        brakes(model, axes)?;
    }
    limits(&model.limits, model.brakes.is_some())
}

fn require(holds: bool, key: &'static str, rule: &'static str) -> Checked {
    if holds {
        Ok(())
    } else {
        Err(ModelError { key, rule })
    }
}

fn positive(key: &'static str, value: f64) -> Checked {
    require(value.is_finite() && value > 0.0, key, POSITIVE)
}

fn not_negative(key: &'static str, value: f64) -> Checked {
    require(value.is_finite() && value >= 0.0, key, NOT_NEGATIVE)
}

/// The axes in use.
#[derive(Clone, Copy)]
struct Active(usize);

impl Active {
    fn all(
        self,
        values: &Axes,
        key: &'static str,
        rule: &'static str,
        holds: fn(f64) -> bool,
    ) -> Checked {
        require(
            values[..self.0].iter().all(|value| holds(*value)),
            key,
            rule,
        )
    }

    fn positive(self, key: &'static str, values: &Axes) -> Checked {
        self.all(values, key, POSITIVE, |value| {
            value.is_finite() && value > 0.0
        })
    }

    fn not_negative(self, key: &'static str, values: &Axes) -> Checked {
        self.all(values, key, NOT_NEGATIVE, |value| {
            value.is_finite() && value >= 0.0
        })
    }

    /// `low` < `high` on every axis in use; also false for NaN.
    fn ordered(self, key: &'static str, rule: &'static str, low: &Axes, high: &Axes) -> Checked {
        let holds = (0..self.0).all(|axis| low[axis] < high[axis]);
        require(holds, key, rule)
    }
}

fn kinematics(model: &KinematicsModel, dof: usize) -> Checked {
    let (axes, low, high) = match *model {
        KinematicsModel::Phantom {
            l1_m,
            l2_m,
            coupling_min_rad,
            coupling_max_rad,
        } => {
            positive("kinematics.l1_m", l1_m)?;
            positive("kinematics.l2_m", l2_m)?;
            (3, coupling_min_rad, coupling_max_rad)
        }
        KinematicsModel::Rhombus {
            l_m,
            opening_min_rad,
            opening_max_rad,
        } => {
            positive("kinematics.l_m", l_m)?;
            (2, opening_min_rad, opening_max_rad)
        }
    };
    require(
        low < high,
        "kinematics",
        "needs its smallest angle below its largest",
    )?;
    require(
        dof == axes,
        "dof",
        "must be the number of joints of the kinematics",
    )
}

fn joints(model: &JointModel, axes: Active) -> Checked {
    axes.all(
        &model.counts_per_rad,
        "joints.counts_per_rad",
        "must be finite and not zero",
        |value| value.is_finite() && value != 0.0,
    )?;
    axes.all(
        &model.zero_rad,
        "joints.zero_rad",
        "must be finite",
        f64::is_finite,
    )?;
    axes.ordered(
        "joints.max_rad",
        "must be above joints.min_rad",
        &model.min_rad,
        &model.max_rad,
    )
}

fn spring(drive: &SpringDriveModel, axes: Active) -> Checked {
    axes.positive("drive.ratio", &drive.ratio)?;
    axes.positive("drive.k_t_nm_per_a", &drive.k_t_nm_per_a)?;
    axes.positive("drive.l_h", &drive.l_h)?;
    axes.positive("drive.r_hat_ohm", &drive.r_hat_ohm)?;
    axes.ordered(
        "drive.r_hat_ohm",
        "must be below drive.r_25_ohm: over-compensation is unstable",
        &drive.r_hat_ohm,
        &drive.r_25_ohm,
    )?;
    axes.positive("drive.k_p_v_per_rad", &drive.k_p_v_per_rad)?;
    axes.not_negative("drive.k_d_v_s_per_rad", &drive.k_d_v_s_per_rad)?;
    axes.positive("drive.voltage_max_v", &drive.voltage_max_v)?;
    axes.positive("drive.current_continuous_a", &drive.current_continuous_a)?;
    axes.ordered(
        "drive.current_max_a",
        "must be above drive.current_continuous_a",
        &drive.current_continuous_a,
        &drive.current_max_a,
    )?;
    positive("drive.peak_time_s", drive.peak_time_s)?;
    let thermal = &drive.thermal;
    positive(
        "drive.thermal.winding_case_k_per_w",
        thermal.winding_case_k_per_w,
    )?;
    positive(
        "drive.thermal.case_ambient_k_per_w",
        thermal.case_ambient_k_per_w,
    )?;
    positive("drive.thermal.winding_s", thermal.winding_s)?;
    positive("drive.thermal.case_s", thermal.case_s)?;
    require(
        thermal.ambient_c < thermal.winding_max_c,
        "drive.thermal.winding_max_c",
        "must be above drive.thermal.ambient_c",
    )
}

fn torque(drive: &TorqueDriveModel, axes: Active) -> Checked {
    axes.positive("drive.torque_continuous_nm", &drive.torque_continuous_nm)?;
    axes.ordered(
        "drive.torque_max_nm",
        "must be above drive.torque_continuous_nm",
        &drive.torque_continuous_nm,
        &drive.torque_max_nm,
    )?;
    positive("drive.peak_time_s", drive.peak_time_s)?;
    not_negative("drive.lag_s", drive.lag_s)?;
    positive("drive.stiffness_n_per_m", drive.stiffness_n_per_m)?;
    not_negative("drive.damping_n_s_per_m", drive.damping_n_s_per_m)
}

fn brakes(model: &BrakeModel, axes: Active) -> Checked {
    axes.positive("brakes.torque_max_nm", &model.torque_max_nm)?;
    axes.not_negative("brakes.drag_nm", &model.drag_nm)?;
    not_negative("brakes.lag_s", model.lag_s)?;
    require(
        (0.0..=10.0).contains(&model.dead_time_s),
        "brakes.dead_time_s",
        "must be between 0 and 10",
    )?;
    not_negative("brakes.hysteresis", model.hysteresis)?;
    positive("brakes.omega_off_rad_per_s", model.omega_off_rad_per_s)?;
    require(
        model.omega_off_rad_per_s < model.omega_on_rad_per_s,
        "brakes.omega_on_rad_per_s",
        "must be above brakes.omega_off_rad_per_s",
    )?;
    not_negative("brakes.hand_torque_min_nm", model.hand_torque_min_nm)
}

fn limits(model: &LimitModel, brakes: bool) -> Checked {
    positive("limits.tip_force_n", model.tip_force_n)?;
    positive("limits.tip_slew_n_per_s", model.tip_slew_n_per_s)?;
    not_negative("limits.brake_slew_nm_per_s", model.brake_slew_nm_per_s)?;
    require(
        !brakes || model.brake_slew_nm_per_s > 0.0,
        "limits.brake_slew_nm_per_s",
        "must be positive where there are brakes",
    )?;
    positive("limits.tip_speed_m_per_s", model.tip_speed_m_per_s)?;
    positive("limits.joint_jump_rad", model.joint_jump_rad)?;
    not_negative("limits.joint_margin_rad", model.joint_margin_rad)?;
    require(
        model.singularity_margin > 0.0 && model.singularity_margin < 1.0,
        "limits.singularity_margin",
        "must be between 0 and 1",
    )?;
    not_negative("limits.sensor_force_n", model.sensor_force_n)?;
    not_negative("limits.sensor_age_s", model.sensor_age_s)?;
    require(
        model.missing_ticks > 0,
        "limits.missing_ticks",
        "must be at least 1",
    )?;
    require(
        model.late_ticks > 0,
        "limits.late_ticks",
        "must be at least 1",
    )?;
    require(
        EXCHANGE_TICKS + model.delay_spare_ticks < DELAYS,
        "limits.delay_spare_ticks",
        "must be 0, 1 or 2",
    )?;
    positive("limits.ramp_s", model.ramp_s)?;
    positive("limits.fade_s", model.fade_s)?;
    positive("limits.heartbeat_s", model.heartbeat_s)
}
