//! A servo put together: region, controller and driver, ready to run on a thread.

use crate::clock::{Monotonic, SECOND_NS};
use crate::config::ServoConfig;
use crate::driver::Driver;
use crate::event::StopReason;
use crate::port::Port;
use crate::region::{Identity, Region, RegionError};
use crate::run::{Loop, Terms};
use crate::scheduling::{measure, obtain};
use crate::twin_driver::TwinDriver;
use hapticd_control::check::ModelError;
use hapticd_control::controller::Controller;
use hapticd_twin::{Twin, TwinError};
use std::sync::atomic::AtomicBool;
use std::sync::Arc;

/// Sleeps of the lateness self-test before the first tick, and how long each is.
const SELF_TEST: (u64, u64) = (200, SECOND_NS / 2000);

/// Why a servo cannot be put together.
#[derive(Debug)]
pub enum ServoError {
    /// The device's model cannot be driven.
    Model(ModelError),
    /// The twin's model cannot be simulated.
    Twin(TwinError),
    /// There is neither a driver nor a twin model, or both.
    NoDevice,
    /// The shared memory cannot be made.
    Region(RegionError),
}

impl std::fmt::Display for ServoError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Model(error) => write!(f, "device_model: {error}"),
            Self::Twin(error) => write!(f, "twin_model: {error}"),
            Self::NoDevice => write!(f, "a servo needs either a driver or a twin_model"),
            Self::Region(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for ServoError {}

impl From<RegionError> for ServoError {
    fn from(error: RegionError) -> Self {
        Self::Region(error)
    }
}

/// A servo that has not started.
pub struct Servo {
    config: ServoConfig,
    region: Arc<Region>,
    controller: Controller,
    driver: Box<dyn Driver>,
}

impl Servo {
    /// Puts a servo together; without `driver` it drives the twin of its configuration. Publishes
    /// the region: from here on a front can attach.
    ///
    /// # Errors
    /// [`ServoError`] naming what does not fit.
    pub fn new(config: ServoConfig, driver: Option<Box<dyn Driver>>) -> Result<Self, ServoError> {
        let controller = Controller::new(&config.device_model, config.rate_hz);
        let controller = controller.map_err(ServoError::Model)?;
        let is_twin = driver.is_none();
        let driver = match (driver, &config.twin_model) {
            (Some(driver), None) => driver,
            (None, Some(_)) => twin_driver(&config)?,
            _ => return Err(ServoError::NoDevice),
        };
        let identity = Identity {
            device_id: &config.device_id,
            rate_hz: config.rate_hz,
            twin: is_twin,
        };
        let region = Arc::new(Region::create(&config.region, &identity)?);
        if is_twin {
            region.set_identity(&format!("twin of {}", config.device_model.name));
        }
        Ok(Self {
            config,
            region,
            controller,
            driver,
        })
    }

    /// The shared memory.
    #[must_use]
    pub fn region(&self) -> Arc<Region> {
        Arc::clone(&self.region)
    }

    /// Makes the calling thread the real-time thread and runs the loop on it until it ends.
    pub fn run(self, stop: &AtomicBool) -> StopReason {
        let wish = self.config.wish();
        let mut obtained = obtain(&wish);
        obtained.self_test = measure(&mut Monotonic, SELF_TEST.0, SELF_TEST.1);
        let terms = Terms {
            rate_hz: self.config.rate_hz,
            heartbeat_ns: nanoseconds(self.config.device_model.limits.heartbeat_s),
            orphan_ns: self.config.orphan_exit_s.map(nanoseconds),
            wish,
            obtained,
        };
        let port = Port::new(&self.region);
        Loop::new(terms, self.controller, self.driver, port, Monotonic).run(stop)
    }
}

fn nanoseconds(duration_s: f64) -> u64 {
    (duration_s * SECOND_NS as f64) as u64
}

fn twin_driver(config: &ServoConfig) -> Result<Box<dyn Driver>, ServoError> {
    let model = config.twin_model.as_ref().ok_or(ServoError::NoDevice)?;
    let twin = Twin::new(&config.device_model, model, config.rate_hz, config.seed);
    let twin = twin.map_err(ServoError::Twin)?;
    Ok(Box::new(TwinDriver::new(twin)))
}
