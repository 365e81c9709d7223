//! A device model: geometry, drives, brakes and limits. Read from `hapticd/devices/*.toml`.

use crate::io::Axes;
use serde::{Deserialize, Serialize};

/// One device as configured. Arrays hold one entry per axis; unused axes are zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceModel {
    /// Model name, e.g. `phantom-1.0`.
    pub name: String,
    /// Joints, and coordinates of the tip: 2 or 3.
    pub dof: usize,
    /// Geometry.
    pub kinematics: KinematicsModel,
    /// Encoders and joint limits.
    pub joints: JointModel,
    /// The tip, as the laws see it.
    pub tip: TipModel,
    /// Velocity estimate.
    pub estimator: EstimatorModel,
    /// What turns set-points into torque.
    pub drive: DriveModel,
    /// Brakes, where there are any.
    pub brakes: Option<BrakeModel>,
    /// Safety limits.
    pub limits: LimitModel,
}

/// Geometry of the linkage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum KinematicsModel {
    /// PHANTOM: base rotation and a parallelogram; q2, q3 against the base.
    Phantom {
        /// Upper link, m.
        l1_m: f64,
        /// Forearm, m.
        l2_m: f64,
        /// Smallest q3 − q2, rad.
        coupling_min_rad: f64,
        /// Largest q3 − q2, rad.
        coupling_max_rad: f64,
    },
    /// HHD: five-bar with coaxial joints and equal links, a rhombus (KS §2.1).
    Rhombus {
        /// Every link, m.
        l_m: f64,
        /// Smallest θ2 − θ1, rad.
        opening_min_rad: f64,
        /// Largest θ2 − θ1, rad.
        opening_max_rad: f64,
    },
}

/// Encoders and limits of the joints.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointModel {
    /// Signed encoder counts per joint radian.
    pub counts_per_rad: Axes,
    /// Joint angle at count zero, rad.
    pub zero_rad: Axes,
    /// Lower limits, rad.
    pub min_rad: Axes,
    /// Upper limits, rad.
    pub max_rad: Axes,
    /// Rest pose, where a twin starts and a device is homed, rad.
    pub home_rad: Axes,
}

/// The tip, as the laws see it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TipModel {
    /// Apparent mass at the tip, kg: smallest of the workspace.
    pub mass_kg: f64,
}

/// Velocity estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EstimatorModel {
    /// λ of the first-order velocity filter, rad/s (WN §III).
    pub lambda_rad_per_s: f64,
}

/// What turns set-points into joint torque.
// Boxing a variant would cost the enum its Copy; there is one per device.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum DriveModel {
    /// Voltage amplifiers with resistance cancellation (WN §II, §III).
    Spring(SpringDriveModel),
    /// Torque-commanded motors behind a virtual coupling (KS).
    Torque(TorqueDriveModel),
}

/// Spring drives, one per joint. Motor-side values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpringDriveModel {
    /// Motor to joint ratio ρ.
    pub ratio: Axes,
    /// Torque constant k_T, N·m/A.
    pub k_t_nm_per_a: Axes,
    /// Winding resistance at 25 °C, Ω.
    pub r_25_ohm: Axes,
    /// Cancelled resistance R̂, Ω.
    pub r_hat_ohm: Axes,
    /// Inductance, H.
    pub l_h: Axes,
    /// Proportional gain K_P, V/rad.
    pub k_p_v_per_rad: Axes,
    /// Derivative gain K_D, V·s/rad.
    pub k_d_v_s_per_rad: Axes,
    /// Largest |e_W|, V.
    pub voltage_max_v: Axes,
    /// Peak current, A.
    pub current_max_a: Axes,
    /// Continuous current, A.
    pub current_continuous_a: Axes,
    /// Time the peak current may last from cold, s.
    pub peak_time_s: f64,
    /// Thermal model of the winding.
    pub thermal: ThermalModel,
}

/// Two-node thermal model of a motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThermalModel {
    /// Ambient temperature, °C.
    pub ambient_c: f64,
    /// Winding to case, K/W.
    pub winding_case_k_per_w: f64,
    /// Case to ambient, K/W.
    pub case_ambient_k_per_w: f64,
    /// Winding time constant, s.
    pub winding_s: f64,
    /// Motor time constant, s.
    pub case_s: f64,
    /// Largest winding temperature, °C.
    pub winding_max_c: f64,
}

/// Torque-commanded motors and the virtual coupling in front of them. Joint-side values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueDriveModel {
    /// Peak torque at the joint, N·m.
    pub torque_max_nm: Axes,
    /// Continuous torque at the joint, N·m.
    pub torque_continuous_nm: Axes,
    /// Time the peak torque may last from cold, s.
    pub peak_time_s: f64,
    /// First-order torque lag, s.
    pub lag_s: f64,
    /// Stiffness of the virtual coupling at the tip, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping of the virtual coupling at the tip, N·s/m.
    pub damping_n_s_per_m: f64,
}

/// Particle brakes, one per joint. Joint-side values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrakeModel {
    /// Largest torque, N·m.
    pub torque_max_nm: Axes,
    /// First-order rise and decay, s.
    pub lag_s: f64,
    /// Dead time before the torque follows, s.
    pub dead_time_s: f64,
    /// Half width of the hysteresis loop, fraction of rated.
    pub hysteresis: f64,
    /// Torque without current, N·m.
    pub drag_nm: Axes,
    /// |q̇| above which a joint counts as moving, rad/s.
    pub omega_on_rad_per_s: f64,
    /// |q̇| below which a joint counts as at rest, rad/s.
    pub omega_off_rad_per_s: f64,
    /// Smallest hand torque that a brake at rest may answer, N·m.
    pub hand_torque_min_nm: f64,
    /// Whether brakes release when outputs are withdrawn; otherwise they hold.
    pub release_on_stop: bool,
}

/// Safety limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitModel {
    /// Largest force at the tip, N.
    pub tip_force_n: f64,
    /// Largest change of the motors' tip force, N/s.
    pub tip_slew_n_per_s: f64,
    /// Largest change of a brake's torque, N·m/s.
    pub brake_slew_nm_per_s: f64,
    /// Tip speed past which an observation is implausible, m/s.
    pub tip_speed_m_per_s: f64,
    /// Joint step in one tick past which an encoder has jumped, rad.
    pub joint_jump_rad: f64,
    /// How far past a joint limit is still plausible, rad.
    pub joint_margin_rad: f64,
    /// sin of the angle to a singularity below which outputs fade, dimensionless.
    pub singularity_margin: f64,
    /// Force of the sensor past which it is saturated, N (0: no sensor).
    pub sensor_force_n: f64,
    /// Largest age of the sensor's force, s.
    pub sensor_age_s: f64,
    /// Ticks in a row without an observation before it is a fault.
    pub missing_ticks: u32,
    /// Late ticks in a row before it is a fault.
    pub late_ticks: u32,
    /// Ticks of delay beyond the exchange's own that passivity control reckons with, 0…2.
    pub delay_spare_ticks: usize,
    /// Time of the ramp into `enabled`, s.
    pub ramp_s: f64,
    /// Time of the fade out of it, s.
    pub fade_s: f64,
    /// Time without a heartbeat of the front before `on_loss` acts, s.
    pub heartbeat_s: f64,
}
