//! The `[twin]` section of a device file: what only the twin needs to know.
//!
//! Nominal values (geometry, motors, brakes) come from the
//! [`DeviceModel`](hapticd_control::model::DeviceModel); the `*_scale` fields say how far the true
//! device is from them, so that a run can ask what happens when the model is wrong.

use hapticd_control::io::Axes;
use serde::{Deserialize, Serialize};

#[allow(clippy::large_enum_variant)] // read once at start, kept by value like every model
/// The plant behind one device model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum TwinModel {
    /// PHANTOM linkage on spring drives.
    Phantom(PhantomTwinModel),
    /// Rhombus linkage with motors, particle brakes and a force sensor.
    Hhd(HhdTwinModel),
}

/// PHANTOM linkage on spring drives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhantomTwinModel {
    /// Steps of the electrical and mechanical equations per tick.
    pub substeps: u32,
    /// Ticks a command waits on its way to the amplifiers.
    pub command_delay_ticks: u32,
    /// Windings and amplifiers.
    pub winding: WindingTwinModel,
    /// Masses of the linkage.
    pub linkage: PhantomLinkageModel,
    /// Joint friction.
    pub friction: FrictionModel,
    /// Mechanical stops.
    pub stops: StopModel,
    /// The operator.
    pub hand: HandModel,
}

/// How the true windings and amplifiers differ from the drive model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindingTwinModel {
    /// Supply of the bridge, V.
    pub supply_v: f64,
    /// True over nominal torque constant.
    pub k_t_scale: Axes,
    /// True over nominal resistance at 25 °C.
    pub r_scale: Axes,
    /// True over nominal inductance.
    pub l_scale: Axes,
    /// True over nominal cancelled resistance R̂.
    pub r_hat_scale: Axes,
    /// Half of the peak-to-peak commutation ripple of R, fraction of R.
    pub brush_ripple: f64,
    /// Ripple periods per motor turn.
    pub brush_periods: f64,
    /// Rotor inertia, kg·m².
    pub rotor_kg_m2: f64,
}

/// Masses of the PHANTOM linkage; bodies and symbols of Cavusoglu's dynamics.
/// Inertias are about the body's centre along its own axes (xx, yy, zz).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhantomLinkageModel {
    /// Forearm tube (body a), kg.
    pub forearm_kg: f64,
    /// Forearm tube, kg·m².
    pub forearm_kg_m2: Axes,
    /// Parallel rod (body c), kg.
    pub rod_kg: f64,
    /// Parallel rod, kg·m².
    pub rod_kg_m2: Axes,
    /// Upper link with its motor (bodies b and e), kg.
    pub upper_kg: f64,
    /// Upper link with its motor, kg·m².
    pub upper_kg_m2: Axes,
    /// Lower link with its motor (bodies d and f), kg.
    pub lower_kg: f64,
    /// Lower link with its motor, kg·m².
    pub lower_kg_m2: Axes,
    /// Base about the vertical, kg·m².
    pub base_kg_m2: f64,
    /// Short link of the parallelogram l3, m.
    pub short_link_m: f64,
    /// Centre of the upper link with its motor past joint 2, l5, m; negative behind it.
    pub upper_offset_m: f64,
    /// Centre of the lower link with its motor behind joint 3, l6, m.
    pub lower_offset_m: f64,
    /// Gravity, m/s².
    pub gravity_m_per_s2: f64,
}

/// Rhombus linkage with motors, particle brakes and a force sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HhdTwinModel {
    /// Steps of the equations per tick.
    pub substeps: u32,
    /// Ticks a command waits on its way to the actuators.
    pub command_delay_ticks: u32,
    /// Motors.
    pub motor: MotorTwinModel,
    /// Brakes.
    pub brake: BrakeTwinModel,
    /// Masses of the linkage.
    pub linkage: RhombusLinkageModel,
    /// Joint friction.
    pub friction: FrictionModel,
    /// Mechanical stops.
    pub stops: StopModel,
    /// Force sensor.
    pub sensor: ForceSensorModel,
    /// The operator.
    pub hand: HandModel,
}

/// How the true torque motors differ from the drive model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorTwinModel {
    /// True over commanded torque.
    pub torque_scale: Axes,
    /// True over nominal torque lag.
    pub lag_scale: f64,
}

/// How the true brakes differ from the brake model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrakeTwinModel {
    /// True over nominal torque.
    pub torque_scale: Axes,
    /// True over nominal lag.
    pub lag_scale: f64,
    /// True dead time, s.
    pub dead_time_s: f64,
    /// True over nominal half width of the hysteresis loop.
    pub hysteresis_scale: f64,
    /// Torque ripple over the brake's angle, fraction.
    pub ripple: f64,
    /// Ripple periods per joint radian.
    pub ripple_per_rad: f64,
}

/// Masses of the rhombus: uniform links, drive inertia at the joints, handle and sensor at the tip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RhombusLinkageModel {
    /// One link, kg.
    pub link_kg: f64,
    /// Handle and force sensor, kg.
    pub tip_kg: f64,
    /// Motor rotor, kg·m².
    pub rotor_kg_m2: f64,
    /// Brake rotor, kg·m².
    pub brake_rotor_kg_m2: f64,
    /// Motor gear N_g.
    pub gear_ratio: f64,
    /// Belt between brake shaft and joint.
    pub belt_ratio: f64,
}

/// Friction of the joints.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionModel {
    /// Coulomb friction, N·m.
    pub coulomb_nm: Axes,
    /// Viscous friction, N·m·s/rad.
    pub viscous_nm_s_per_rad: Axes,
}

/// Mechanical stops behind the joint limits and the limits of the angle between the links.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopModel {
    /// Distance of a stop behind its limit, rad.
    pub margin_rad: f64,
    /// Stiffness, N·m/rad.
    pub stiffness_nm_per_rad: f64,
    /// Damping while touched, N·m·s/rad.
    pub damping_nm_s_per_rad: f64,
}

/// Force sensor between tip and handle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceSensorModel {
    /// First-order bandwidth, Hz.
    pub bandwidth_hz: f64,
    /// Standard deviation of the noise, N.
    pub noise_n: f64,
    /// Resolution, N.
    pub lsb_n: f64,
    /// Bias, N.
    pub bias_n: Axes,
    /// Range, N.
    pub range_n: f64,
}

/// Two-mass operator: the grip joins tip and hand, the arm joins hand and intention.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandModel {
    /// Hand and forearm m_a, kg.
    pub mass_kg: f64,
    /// Grip k_g, N/m.
    pub grip_stiffness_n_per_m: f64,
    /// Grip b_g, N·s/m.
    pub grip_damping_n_s_per_m: f64,
    /// Arm k_a, N/m.
    pub arm_stiffness_n_per_m: f64,
    /// Arm b_a, N·s/m.
    pub arm_damping_n_s_per_m: f64,
    /// Largest force of the arm, N.
    pub arm_force_max_n: f64,
    /// Factor on arm stiffness and damping while braced.
    pub brace: f64,
    /// Bandwidth with which the intention reaches for a point, rad/s.
    pub reach_rad_per_s: f64,
    /// Largest speed of the reach, m/s.
    pub reach_m_per_s: f64,
    /// Time in which too large a push is taken back, s.
    pub relax_s: f64,
    /// Bench clamp, N/m.
    pub clamp_stiffness_n_per_m: f64,
    /// Bench clamp, N·s/m.
    pub clamp_damping_n_s_per_m: f64,
}
