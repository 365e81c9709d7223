//! Whether a twin model makes physical sense.

use crate::error::TwinError;
use crate::model::{
    BrakeTwinModel, ForceSensorModel, FrictionModel, HandModel, HhdTwinModel, PhantomTwinModel,
    StopModel, TwinModel, WindingTwinModel,
};
use hapticd_control::check::check as check_device;
use hapticd_control::io::Axes;
use hapticd_control::model::DeviceModel;

/// Longest step the explicit parts of the equations stand, s.
const LONGEST_STEP_S: f64 = 3e-4;

impl TwinModel {
    /// Checks the model against its device and the tick rate.
    ///
    /// # Errors
    /// [`TwinError`] naming the first value that makes no sense.
    pub fn check(&self, device: &DeviceModel, rate_hz: f64) -> Result<(), TwinError> {
        check_device(device, rate_hz).map_err(TwinError::Device)?;
        let dof = device.dof;
        let substeps = match self {
            Self::Phantom(model) => model.check(dof)?,
            Self::Hhd(model) => model.check(dof)?,
        };
        let step_s = 1.0 / (rate_hz * f64::from(substeps.max(1)));
        wanted(
            "substeps",
            f64::from(substeps),
            "enough for steps of 0.3 ms at most",
            step_s <= LONGEST_STEP_S,
        )
    }

    /// Ticks a command waits on its way to the actuators.
    #[must_use]
    pub fn command_delay_ticks(&self) -> u32 {
        match self {
            Self::Phantom(model) => model.command_delay_ticks,
            Self::Hhd(model) => model.command_delay_ticks,
        }
    }

    /// Range of the force sensor, N; zero without one.
    #[must_use]
    pub fn sensor_range_n(&self) -> f64 {
        match self {
            Self::Phantom(_) => 0.0,
            Self::Hhd(model) => model.sensor.range_n,
        }
    }
}

impl PhantomTwinModel {
    /// Steps per tick, when all values make sense.
    fn check(&self, dof: usize) -> Result<u32, TwinError> {
        self.winding.check(dof)?;
        self.friction.check()?;
        self.stops.check()?;
        self.hand.check()?;
        for (key, kg) in [
            ("linkage.forearm_kg", self.linkage.forearm_kg),
            ("linkage.rod_kg", self.linkage.rod_kg),
            ("linkage.upper_kg", self.linkage.upper_kg),
            ("linkage.lower_kg", self.linkage.lower_kg),
            ("linkage.base_kg_m2", self.linkage.base_kg_m2),
        ] {
            positive(key, kg)?;
        }
        Ok(self.substeps)
    }
}

impl HhdTwinModel {
    /// Steps per tick, when all values make sense.
    fn check(&self, dof: usize) -> Result<u32, TwinError> {
        positive_axes("motor.torque_scale", &self.motor.torque_scale, dof)?;
        positive("motor.lag_scale", self.motor.lag_scale)?;
        self.brake.check(dof)?;
        positive("linkage.link_kg", self.linkage.link_kg)?;
        not_negative("linkage.tip_kg", self.linkage.tip_kg)?;
        self.friction.check()?;
        self.stops.check()?;
        self.sensor.check()?;
        self.hand.check()?;
        Ok(self.substeps)
    }
}

impl WindingTwinModel {
    fn check(&self, dof: usize) -> Result<(), TwinError> {
        positive("winding.supply_v", self.supply_v)?;
        positive_axes("winding.k_t_scale", &self.k_t_scale, dof)?;
        positive_axes("winding.r_scale", &self.r_scale, dof)?;
        positive_axes("winding.l_scale", &self.l_scale, dof)?;
        positive_axes("winding.r_hat_scale", &self.r_hat_scale, dof)?;
        wanted(
            "winding.brush_ripple",
            self.brush_ripple,
            "0 to 1",
            (0.0..1.0).contains(&self.brush_ripple),
        )
    }
}

impl BrakeTwinModel {
    fn check(&self, dof: usize) -> Result<(), TwinError> {
        positive_axes("brake.torque_scale", &self.torque_scale, dof)?;
        positive("brake.lag_scale", self.lag_scale)?;
        not_negative("brake.hysteresis_scale", self.hysteresis_scale)?;
        wanted(
            "brake.dead_time_s",
            self.dead_time_s,
            "0 to 1",
            (0.0..=1.0).contains(&self.dead_time_s),
        )?;
        wanted(
            "brake.ripple",
            self.ripple,
            "0 to 1",
            (0.0..1.0).contains(&self.ripple),
        )
    }
}

impl FrictionModel {
    fn check(&self) -> Result<(), TwinError> {
        for axis in 0..3 {
            not_negative("friction.coulomb_nm", self.coulomb_nm[axis])?;
            not_negative(
                "friction.viscous_nm_s_per_rad",
                self.viscous_nm_s_per_rad[axis],
            )?;
        }
        Ok(())
    }
}

impl StopModel {
    fn check(&self) -> Result<(), TwinError> {
        not_negative("stops.margin_rad", self.margin_rad)?;
        not_negative("stops.stiffness_nm_per_rad", self.stiffness_nm_per_rad)?;
        not_negative("stops.damping_nm_s_per_rad", self.damping_nm_s_per_rad)
    }
}

impl ForceSensorModel {
    fn check(&self) -> Result<(), TwinError> {
        positive("sensor.bandwidth_hz", self.bandwidth_hz)?;
        not_negative("sensor.noise_n", self.noise_n)?;
        positive("sensor.lsb_n", self.lsb_n)?;
        positive("sensor.range_n", self.range_n)
    }
}

impl HandModel {
    fn check(&self) -> Result<(), TwinError> {
        for (key, value) in [
            ("hand.mass_kg", self.mass_kg),
            ("hand.grip_stiffness_n_per_m", self.grip_stiffness_n_per_m),
            ("hand.arm_stiffness_n_per_m", self.arm_stiffness_n_per_m),
            ("hand.arm_force_max_n", self.arm_force_max_n),
            ("hand.brace", self.brace),
            ("hand.reach_rad_per_s", self.reach_rad_per_s),
            ("hand.reach_m_per_s", self.reach_m_per_s),
            ("hand.relax_s", self.relax_s),
            ("hand.clamp_stiffness_n_per_m", self.clamp_stiffness_n_per_m),
        ] {
            positive(key, value)?;
        }
        not_negative("hand.grip_damping_n_s_per_m", self.grip_damping_n_s_per_m)?;
        not_negative("hand.arm_damping_n_s_per_m", self.arm_damping_n_s_per_m)?;
        not_negative("hand.clamp_damping_n_s_per_m", self.clamp_damping_n_s_per_m)
    }
}

fn positive(key: &'static str, value: f64) -> Result<(), TwinError> {
    wanted(key, value, "positive", value > 0.0)
}

fn not_negative(key: &'static str, value: f64) -> Result<(), TwinError> {
    wanted(key, value, "zero or more", value >= 0.0)
}

fn positive_axes(key: &'static str, values: &Axes, dof: usize) -> Result<(), TwinError> {
    values
        .iter()
        .take(dof)
        .try_for_each(|value| positive(key, *value))
}

fn wanted(
    key: &'static str,
    value: f64,
    wanted: &'static str,
    holds: bool,
) -> Result<(), TwinError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(TwinError::OutOfRange { key, value, wanted })
    }
}
