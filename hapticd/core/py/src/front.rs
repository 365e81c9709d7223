//! Binding of the front's end of a servo's shared memory.

mod report;

use hapticd_control::record::RECORD_WORDS;
use hapticd_servo::ack::Ack;
use hapticd_servo::document::parse;
use hapticd_servo::event::ServoEvent;
use hapticd_servo::front::{Front as Link, SendError};
use hapticd_servo::region::RegionError as CoreRegionError;
use hapticd_servo::ring::RingReader;
use hapticd_servo::status::{Status, STATUS_WORDS};
use pyo3::create_exception;
use pyo3::exceptions::{PyBlockingIOError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use report::{AckDict, EventDict, InfoDict, StatusDict};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

create_exception!(_core, RegionError, PyRuntimeError);

/// Adds this file's names to `hapticd._core`.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("RegionError", module.py().get_type::<RegionError>())?;
    module.add_class::<Front>()
}

/// The exception for a region that cannot be used.
pub fn region_error(error: CoreRegionError) -> PyErr {
    match error {
        CoreRegionError::Io(error) => error.into(),
        other => RegionError::new_err(other.to_string()),
    }
}

fn send_error(error: SendError) -> PyErr {
    match error {
        SendError::Full => PyBlockingIOError::new_err("the servo's request queue is full"),
        SendError::Observer => RegionError::new_err("an observer neither sends nor beats"),
    }
}

/// One servo's shared memory, as its front. Every method may be called from any thread.
#[pyclass(frozen, module = "hapticd._core")]
struct Front {
    link: Mutex<Option<Arc<Link>>>,
    next_ack: Mutex<u64>,
    next_event: Mutex<u64>,
}

#[pymethods]
impl Front {
    #[new]
    #[pyo3(signature = (path, *, observe=false))]
    fn new(path: PathBuf, observe: bool) -> PyResult<Self> {
        let link = Link::attach(&path, observe).map_err(region_error)?;
        let next_ack = Mutex::new(link.region().acks().head());
        Ok(Self {
            link: Mutex::new(Some(Arc::new(link))),
            next_ack,
            next_event: Mutex::new(0),
        })
    }

    fn info(&self) -> PyResult<InfoDict> {
        Ok(InfoDict::of(self.link()?.region()))
    }

    fn heartbeat(&self) -> PyResult<()> {
        self.link()?.heartbeat().map_err(send_error)
    }

    fn send(&self, request_json: &str) -> PyResult<u64> {
        let (request, epoch) = parse(request_json).map_err(PyValueError::new_err)?;
        self.link()?.send(request, epoch).map_err(send_error)
    }

    fn acks(&self) -> PyResult<Vec<AckDict>> {
        let link = self.link()?;
        let (records, _) = drain(&link.region().acks(), &self.next_ack);
        let acks = records.iter().filter_map(|words| Ack::decode(words));
        Ok(acks.map(|ack| AckDict::of(&ack)).collect())
    }

    fn events(&self) -> PyResult<Vec<EventDict>> {
        let link = self.link()?;
        let mut next = self
            .next_event
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let (mut events, since) = (Vec::new(), *next);
        let (records, first) = drain_from(&link.region().events(), &mut next);
        for (seq, words) in (first..).zip(&records) {
            if let Some(event) = ServoEvent::decode(words) {
                if events.is_empty() && first > since {
                    events.push(EventDict::overflow(seq, &event, first - since));
                }
                events.push(EventDict::of(seq, &event));
            }
        }
        Ok(events)
    }

    fn head(&self) -> PyResult<u64> {
        Ok(self.link()?.region().ticks().head())
    }

    fn read<'py>(
        &self,
        py: Python<'py>,
        since: u64,
        max_ticks: usize,
    ) -> PyResult<(Bound<'py, PyBytes>, u64, u64)> {
        let link = self.link()?;
        // Four seconds of ticks take a millisecond to copy: other threads may run meanwhile.
        let (bytes, first) = py.detach(|| {
            let mut words = Vec::new();
            let ticks = link.region().ticks();
            let first = ticks.read_since(since, max_ticks, &mut words);
            (to_bytes(&words), first)
        });
        Ok((PyBytes::new(py, &bytes), first, first - since))
    }

    fn latest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut words = [0; RECORD_WORDS];
        let found = self.link()?.region().ticks().latest(&mut words);
        let bytes = found.map_or_else(Vec::new, |_| to_bytes(&words));
        Ok(PyBytes::new(py, &bytes))
    }

    fn status(&self) -> PyResult<Option<StatusDict>> {
        let link = self.link()?;
        let mut words = [0; STATUS_WORDS];
        let found = link.region().status().latest(&mut words);
        let status = found.and_then(|_| Status::decode(&words));
        Ok(status.map(|status| StatusDict::of(&status, &link)))
    }

    fn servo_alive(&self) -> PyResult<bool> {
        Ok(self.link()?.servo_alive())
    }

    fn close(&self) {
        let mut link = self.link.lock().unwrap_or_else(PoisonError::into_inner);
        *link = None;
    }
}

impl Front {
    fn link(&self) -> PyResult<Arc<Link>> {
        let link = self.link.lock().unwrap_or_else(PoisonError::into_inner);
        let link = link.as_ref().map(Arc::clone);
        link.ok_or_else(|| RegionError::new_err("this end of the shared memory is closed"))
    }
}

/// Every record from `next` on, and the number of the first; moves `next` past the last.
fn drain_from(ring: &RingReader<'_>, next: &mut u64) -> (Vec<Vec<u64>>, u64) {
    let mut words = Vec::new();
    let first = ring.read_since(*next, usize::MAX, &mut words);
    let records: Vec<_> = words
        .chunks(ring.record_words())
        .map(<[u64]>::to_vec)
        .collect();
    *next = first + records.len() as u64;
    (records, first)
}

fn drain(ring: &RingReader<'_>, next: &Mutex<u64>) -> (Vec<Vec<u64>>, u64) {
    drain_from(
        ring,
        &mut next.lock().unwrap_or_else(PoisonError::into_inner),
    )
}

fn to_bytes(words: &[u64]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_ne_bytes()).collect()
}
