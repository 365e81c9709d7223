//! What a servo is started with: one JSON document, written by whoever starts it.

use crate::scheduling::{Realtime, Wish};
use hapticd_control::model::DeviceModel;
use hapticd_twin::TwinModel;
use serde::Deserialize;
use std::path::PathBuf;

/// Slowest loop, Hz.
const RATE_MIN_HZ: f64 = 100.0;
/// Fastest loop, Hz.
const RATE_MAX_HZ: f64 = 20_000.0;

/// The document.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoConfig {
    /// The device's id.
    pub device_id: String,
    /// The device's model.
    pub device_model: DeviceModel,
    /// The twin's plant; without one the device has a driver.
    #[serde(default)]
    pub twin_model: Option<TwinModel>,
    /// Rate of the loop, Hz.
    pub rate_hz: f64,
    /// File of the shared region.
    pub region: PathBuf,
    /// How much the device needs real-time scheduling.
    #[serde(default)]
    pub realtime: Realtime,
    /// `SCHED_FIFO` priority.
    #[serde(default = "default_priority")]
    pub priority: u8,
    /// CPU to stay on.
    #[serde(default)]
    pub cpu: Option<usize>,
    /// Seed of the twin's noise.
    #[serde(default)]
    pub seed: u64,
    /// Without a front for this long the servo ends, s; `null`: never.
    #[serde(default = "default_orphan_exit_s")]
    pub orphan_exit_s: Option<f64>,
}

const fn default_priority() -> u8 {
    80
}

#[allow(clippy::unnecessary_wraps)] // serde wants the field's type
const fn default_orphan_exit_s() -> Option<f64> {
    Some(10.0)
}

impl ServoConfig {
    /// The configuration in `json`.
    ///
    /// # Errors
    /// What is wrong with it, naming the key.
    pub fn parse(json: &str) -> Result<Self, String> {
        let mut document = serde_json::Deserializer::from_str(json);
        let config: Self = serde_path_to_error::deserialize(&mut document)
            .map_err(|error| format!("{}: {}", error.path(), error.inner()))?;
        if !(RATE_MIN_HZ..=RATE_MAX_HZ).contains(&config.rate_hz) {
            return Err(format!(
                "rate_hz is {}, it must be {RATE_MIN_HZ} to {RATE_MAX_HZ}",
                config.rate_hz
            ));
        }
        if !(1..=99).contains(&config.priority) {
            return Err(format!(
                "priority is {}, it must be 1 to 99",
                config.priority
            ));
        }
        if config.orphan_exit_s.is_some_and(|wait_s| wait_s <= 0.0) {
            return Err("orphan_exit_s must be positive, or null".into());
        }
        Ok(config)
    }

    /// The scheduling to ask for.
    #[must_use]
    pub fn wish(&self) -> Wish {
        Wish {
            realtime: self.realtime,
            priority: self.priority,
            cpu: self.cpu,
        }
    }
}
