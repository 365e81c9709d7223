//! Binding of the real-time loop.

use crate::driver::PythonDriver;
use crate::front::region_error;
use crate::parking::Parking;
use hapticd_servo::config::ServoConfig;
use hapticd_servo::driver::Driver;
use hapticd_servo::event::StopReason;
use hapticd_servo::region::Region;
use hapticd_servo::servo::{Servo as CoreServo, ServoError};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// Stack of the real-time thread, bytes. All of it is locked into memory; a Python driver runs on
/// it, and the scenes of a cross-fade, 50 kB each, pass over it.
const STACK_BYTES: usize = 4 << 20;

/// Adds this file's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Servo>()
}

fn servo_error(error: ServoError) -> PyErr {
    match error {
        ServoError::Region(error) => region_error(error),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// One device's real-time loop.
#[pyclass(frozen, module = "hapticd._core")]
struct Servo {
    prepared: Mutex<Option<CoreServo>>,
    thread: Mutex<Option<JoinHandle<()>>>,
    region: Arc<Region>,
    parking: Arc<Parking>,
    stop: Arc<AtomicBool>,
    driver: Option<Py<PyAny>>,
}

#[pymethods]
impl Servo {
    #[new]
    #[pyo3(signature = (config_json, driver))]
    fn new(config_json: &str, driver: Option<Bound<'_, PyAny>>) -> PyResult<Self> {
        let config = ServoConfig::parse(config_json).map_err(PyValueError::new_err)?;
        let parking = Arc::new(Parking::new(driver.is_some())?);
        let wrap = |driver: &Bound<'_, PyAny>| -> PyResult<Box<dyn Driver>> {
            Ok(Box::new(PythonDriver::new(driver, Arc::clone(&parking))?))
        };
        let wrapped = driver.as_ref().map(wrap).transpose()?;
        let prepared = CoreServo::new(config, wrapped).map_err(servo_error)?;
        Ok(Self {
            region: prepared.region(),
            prepared: Mutex::new(Some(prepared)),
            thread: Mutex::new(None),
            parking,
            stop: Arc::new(AtomicBool::new(false)),
            driver: driver.map(Bound::unbind),
        })
    }

    fn start(&self) -> PyResult<()> {
        let prepared = self
            .prepared
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        let prepared = prepared.ok_or_else(|| PyRuntimeError::new_err("a servo starts once"))?;
        let (stop, parking) = (Arc::clone(&self.stop), Arc::clone(&self.parking));
        let thread = std::thread::Builder::new()
            .name("servo".into())
            .stack_size(STACK_BYTES)
            .spawn(move || parking.end(run(prepared, &stop)))?;
        *self.thread.lock().unwrap_or_else(PoisonError::into_inner) = Some(thread);
        Ok(())
    }

    fn wait(&self, py: Python<'_>) -> PyResult<String> {
        loop {
            if let Some(how) = self.parking.ended() {
                self.join(py);
                return Ok(how);
            }
            if self.parking.take_down() {
                return Ok("down".into());
            }
            py.detach(|| self.parking.sleep())?;
            py.check_signals()?;
        }
    }

    fn driver_ready(&self, py: Python<'_>) -> PyResult<()> {
        if let Some(driver) = &self.driver {
            let identity: String = driver.getattr(py, "identity")?.extract(py)?;
            self.region.set_identity(&identity);
            self.parking.driver_ready();
        }
        Ok(())
    }

    fn request_stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    fn driver_error(&self) -> Option<String> {
        self.parking.driver_error()
    }

    fn wake_fd(&self) -> i32 {
        self.parking.wake_fd()
    }
}

impl Servo {
    fn join(&self, py: Python<'_>) {
        let thread = self
            .thread
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        // The thread may need the GIL for its last steps. How it ended is known already.
        py.detach(|| thread.map(JoinHandle::join));
    }
}

/// Runs the loop on this thread and says how it ended.
fn run(prepared: CoreServo, stop: &AtomicBool) -> String {
    // Attached for the loop's whole life, so that a call into Python does not make and destroy a
    // thread state each tick; detached at once, so that the GIL is held only inside the driver.
    let ended =
        Python::attach(|py| py.detach(|| catch_unwind(AssertUnwindSafe(|| prepared.run(stop)))));
    match ended {
        Ok(StopReason::Requested) => "stopped".into(),
        Ok(StopReason::Orphaned) => "orphaned".into(),
        Err(panic) => format!("failed: {}", panic_text(panic.as_ref())),
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("the loop panicked")
}
