//! Binding of the twin crate: a plant alone, and the loop closed over one.

use hapticd_control::check::check;
use hapticd_control::controller::{Controller, TickInput};
use hapticd_control::io::{Axes, Command, Observation};
use hapticd_control::model::DeviceModel;
use hapticd_control::record::{TickRecord, RECORD_WORDS};
use hapticd_servo::document;
use hapticd_servo::request::Request;
use hapticd_twin::{Script, Truth, Twin, TwinModel};
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Bytes of a command: enable, then volts, motor torques and brake torques, ten `f64`.
const COMMAND_BYTES: usize = 80;

/// Bytes of an observation, in the order of its declaration.
const OBSERVATION_BYTES: usize = 13 * 8;

/// Adds this module's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(check_model, module)?)?;
    module.add_class::<Plant>()?;
    module.add_class::<Simulation>()
}

/// Rate at which a model is checked that is not driven yet, Hz.
const CHECK_RATE_HZ: f64 = 1000.0;

/// Checks a device model and, unless it is `null`, its twin.
#[pyfunction]
fn check_model(device_json: &str, twin_json: &str) -> PyResult<()> {
    let device: DeviceModel = serde_json::from_str(device_json).map_err(value_error)?;
    check(&device, CHECK_RATE_HZ).map_err(value_error)?;
    let twin: Option<TwinModel> = serde_json::from_str(twin_json).map_err(value_error)?;
    twin.map_or(Ok(()), |twin| {
        twin.check(&device, CHECK_RATE_HZ).map_err(value_error)
    })
}

/// A twin as a board sees it: commands in, observations out.
#[pyclass(module = "hapticd._core")]
struct Plant {
    twin: Twin,
}

#[pymethods]
impl Plant {
    #[new]
    fn new(device_json: &str, twin_json: &str, rate_hz: f64, seed: u64) -> PyResult<Self> {
        let (_, twin) = build(device_json, twin_json, rate_hz, seed)?;
        Ok(Self { twin })
    }

    /// One tick under a command; returns the observation latched at its start.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        command: PyBuffer<u8>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let command = decode_command(&command.to_vec(py)?)?;
        let (_, observation) = self.twin.step(&command);
        Ok(PyBytes::new(py, &encode_observation(&observation)))
    }

    /// Tells the hand what to do.
    fn hand(&mut self, script_json: &str) -> PyResult<()> {
        let script: Script = serde_json::from_str(script_json).map_err(value_error)?;
        if !script.is_valid() {
            return Err(PyValueError::new_err(
                "a number of the script makes no sense",
            ));
        }
        self.twin.hand(script);
        Ok(())
    }

    /// The true state at the last latch.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        truth_dict(py, &self.twin.truth())
    }
}

/// Controller and twin in one closed loop, as fast as it goes.
#[pyclass(module = "hapticd._core")]
struct Simulation {
    controller: Controller,
    twin: Twin,
    rate_hz: f64,
    tick: u64,
    command: Command,
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(device_json: &str, twin_json: &str, rate_hz: f64, seed: u64) -> PyResult<Self> {
        let (device, twin) = build(device_json, twin_json, rate_hz, seed)?;
        let controller = Controller::new(&device, rate_hz).map_err(value_error)?;
        Ok(Self {
            controller,
            twin,
            rate_hz,
            tick: 0,
            command: Command::default(),
        })
    }

    /// Carries out a request, the same JSON a servo takes. Returns the open interlocks that
    /// refuse it, 0 when it was applied.
    fn request(&mut self, request_json: &str) -> PyResult<u64> {
        let (request, _) = document::parse(request_json).map_err(PyValueError::new_err)?;
        match request {
            Request::Event(event) => {
                return Ok(self
                    .controller
                    .event(event)
                    .err()
                    .map_or(0, |r| r.interlocks))
            }
            Request::Scene(scene) => self.controller.adopt(&scene),
            Request::Hand(script) => self.twin.hand(script),
            Request::Inject(injection) => self.twin.inject(injection),
            Request::Stop => {
                return Err(PyValueError::new_err("a simulation has no process to stop"))
            }
        }
        Ok(0)
    }

    /// Runs `ticks` ticks; returns their records one after the other.
    fn run<'py>(&mut self, py: Python<'py>, ticks: usize) -> PyResult<Bound<'py, PyBytes>> {
        PyBytes::new_with(py, ticks * RECORD_WORDS * 8, |bytes| {
            py.detach(|| {
                for slot in bytes.chunks_exact_mut(RECORD_WORDS * 8) {
                    encode_record(&self.tick(), slot);
                }
            });
            Ok(())
        })
    }

    /// The true state at the latch of the last tick's observation.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        truth_dict(py, &self.twin.truth())
    }
}

impl Simulation {
    fn tick(&mut self) -> TickRecord {
        let (exchange, observation) = self.twin.step(&self.command);
        let input = TickInput {
            tick: self.tick,
            t_mono_ns: (self.tick as f64 / self.rate_hz * 1e9).round() as u64,
            exchange,
            observation: &observation,
            front_alive: true,
            late: false,
            realtime_ok: true,
        };
        let mut record = TickRecord::default();
        self.command = self.controller.tick(&input, &mut record);
        let truth = self.twin.truth();
        record.hand_position_m = truth.hand_position_m;
        record.hand_force_n = truth.hand_force_n;
        self.tick += 1;
        record
    }
}

fn build(
    device_json: &str,
    twin_json: &str,
    rate_hz: f64,
    seed: u64,
) -> PyResult<(DeviceModel, Twin)> {
    let device: DeviceModel = serde_json::from_str(device_json).map_err(value_error)?;
    let model: TwinModel = serde_json::from_str(twin_json).map_err(value_error)?;
    let twin = Twin::new(&device, &model, rate_hz, seed).map_err(value_error)?;
    Ok((device, twin))
}

fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn decode_command(bytes: &[u8]) -> PyResult<Command> {
    if bytes.len() != COMMAND_BYTES {
        return Err(PyValueError::new_err(format!(
            "a command is {COMMAND_BYTES} bytes, not {}",
            bytes.len()
        )));
    }
    let mut words = [0.0; COMMAND_BYTES / 8];
    for (word, chunk) in words.iter_mut().zip(bytes.chunks_exact(8)) {
        let mut raw = [0; 8];
        raw.copy_from_slice(chunk);
        *word = f64::from_le_bytes(raw);
    }
    let [enable, v1, v2, v3, m1, m2, m3, b1, b2, b3] = words;
    Ok(Command {
        enable: enable != 0.0,
        motor_v: [v1, v2, v3],
        motor_torque_nm: [m1, m2, m3],
        brake_torque_nm: [b1, b2, b3],
    })
}

fn encode_observation(observation: &Observation) -> [u8; OBSERVATION_BYTES] {
    let o = observation;
    let floats = |values: Axes| values.map(f64::to_bits);
    let words = [o.seq, o.t_device_ns]
        .into_iter()
        .chain(o.counts.map(|count| count as u64))
        .chain(floats(o.force_n))
        .chain([o.force_age_s.to_bits()])
        .chain(floats(o.motor_current_a))
        .chain([o.status]);
    let mut bytes = [0; OBSERVATION_BYTES];
    for (slot, word) in bytes.chunks_exact_mut(8).zip(words) {
        slot.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

fn encode_record(record: &TickRecord, slot: &mut [u8]) {
    for (bytes, word) in slot.chunks_exact_mut(8).zip(record.words()) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
}

fn truth_dict<'py>(py: Python<'py>, truth: &Truth) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("hand_position_m", truth.hand_position_m)?;
    dict.set_item("hand_force_n", truth.hand_force_n)?;
    dict.set_item("joint_position_rad", truth.joint_position_rad)?;
    dict.set_item("joint_velocity_rad_per_s", truth.joint_velocity_rad_per_s)?;
    dict.set_item("tip_position_m", truth.tip_position_m)?;
    dict.set_item("tip_velocity_m_per_s", truth.tip_velocity_m_per_s)?;
    dict.set_item("motor_current_a", truth.motor_current_a)?;
    dict.set_item("motor_torque_nm", truth.motor_torque_nm)?;
    dict.set_item("brake_torque_nm", truth.brake_torque_nm)?;
    dict.set_item("winding_c", truth.winding_c)?;
    Ok(dict)
}
