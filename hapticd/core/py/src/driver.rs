//! A driver written in Python, as the loop sees it.

use crate::parking::{Parking, Wake};
use hapticd_control::io::{Axes, Command, Exchange, Observation, AXES};
use hapticd_servo::driver::Driver;
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyMemoryView};
use std::sync::Arc;

/// Words of a command: enable, volts, motor torques, brake torques.
const COMMAND_WORDS: usize = 1 + 3 * AXES;
/// Words of an observation, in the order of [`Observation`].
const OBSERVATION_WORDS: usize = 2 + AXES + AXES + 1 + AXES + 1;

/// Calls `exchange(command, observation)` of a Python object, with two buffers made once.
pub struct PythonDriver {
    exchange: Py<PyAny>,
    arguments: (Py<PyAny>, Py<PyAny>),
    command: PyBuffer<u8>,
    observation: PyBuffer<u8>,
    parking: Arc<Parking>,
}

impl PythonDriver {
    /// Wraps `driver`. The loop calls it only while `parking` says that it is connected.
    pub fn new(driver: &Bound<'_, PyAny>, parking: Arc<Parking>) -> PyResult<Self> {
        let py = driver.py();
        let (command, command_view) = buffer(py, COMMAND_WORDS)?;
        let (observation, observation_view) = buffer(py, OBSERVATION_WORDS)?;
        Ok(Self {
            exchange: driver.getattr("exchange")?.unbind(),
            arguments: (command_view, observation_view),
            command,
            observation,
            parking,
        })
    }

    fn call(&self, py: Python<'_>, command: &Command) -> PyResult<Exchange> {
        self.command.copy_from_slice(py, &command_bytes(command))?;
        let (command, observation) = &self.arguments;
        let code: u8 = self
            .exchange
            .call1(py, (command, observation))?
            .extract(py)?;
        match code {
            0 => Ok(Exchange::Fresh),
            1 => Ok(Exchange::Missing),
            2 => Ok(Exchange::Down),
            other => Err(PyValueError::new_err(format!(
                "exchange returned {other}: 0 is fresh, 1 is missing, 2 is down"
            ))),
        }
    }

    fn take(&self, py: Python<'_>, observation: &mut Observation) -> PyResult<()> {
        let mut bytes = [0; OBSERVATION_WORDS * 8];
        self.observation.copy_to_slice(py, &mut bytes)?;
        *observation = observation_of(&bytes);
        Ok(())
    }
}

impl Driver for PythonDriver {
    fn exchange(&mut self, command: &Command, observation: &mut Observation) -> Exchange {
        if !self.parking.driver_is_ready() {
            return Exchange::Down;
        }
        let exchange = Python::attach(|py| {
            let exchange = self.call(py, command)?;
            if exchange == Exchange::Fresh {
                self.take(py, observation)?;
            }
            PyResult::Ok(exchange)
        });
        match exchange {
            Ok(Exchange::Down) => self.lose(None),
            Ok(exchange) => exchange,
            Err(error) => self.lose(Some(error.to_string())),
        }
    }
}

impl PythonDriver {
    /// Leaves the driver to the parked main thread until that has connected it again.
    fn lose(&self, why: Option<String>) -> Exchange {
        self.parking.driver_lost(why);
        self.parking.wake(Wake::Down);
        Exchange::Down
    }
}

/// A buffer of zeros and the view of it that the driver is given.
fn buffer(py: Python<'_>, words: usize) -> PyResult<(PyBuffer<u8>, Py<PyAny>)> {
    let bytes = PyByteArray::new(py, &vec![0; words * 8]);
    let view = PyMemoryView::from(&bytes)?;
    Ok((PyBuffer::get(&bytes)?, view.into_any().unbind()))
}

fn command_bytes(command: &Command) -> [u8; COMMAND_WORDS * 8] {
    let mut words = [0.0; COMMAND_WORDS];
    words[0] = f64::from(u8::from(command.enable));
    words[1..4].copy_from_slice(&command.motor_v);
    words[4..7].copy_from_slice(&command.motor_torque_nm);
    words[7..10].copy_from_slice(&command.brake_torque_nm);
    let mut bytes = [0; COMMAND_WORDS * 8];
    for (chunk, word) in bytes.chunks_exact_mut(8).zip(words) {
        chunk.copy_from_slice(&word.to_ne_bytes());
    }
    bytes
}

fn observation_of(bytes: &[u8; OBSERVATION_WORDS * 8]) -> Observation {
    let word = |index: usize| -> [u8; 8] {
        let mut word = [0; 8];
        word.copy_from_slice(&bytes[index * 8..index * 8 + 8]);
        word
    };
    let unsigned = |index| u64::from_ne_bytes(word(index));
    let number = |index| f64::from_ne_bytes(word(index));
    let axes = |index| -> Axes { [number(index), number(index + 1), number(index + 2)] };
    Observation {
        seq: unsigned(0),
        t_device_ns: unsigned(1),
        counts: [2, 3, 4].map(|index| i64::from_ne_bytes(word(index))),
        force_n: axes(5),
        force_age_s: number(8),
        motor_current_a: axes(9),
        status: unsigned(12),
    }
}
