//! The loop's ends of the shared region.

use crate::ack::Ack;
use crate::event::ServoEvent;
use crate::layout::live;
use crate::mailbox::{Garbled, Receiver};
use crate::region::Region;
use crate::request::{Envelope, REQUEST_WORDS};
use crate::ring::RingWriter;
use crate::status::{Phase, Status, STATUS_WORDS};
use crate::sync::Ordering;
use hapticd_control::record::TickRecord;

/// Everything the loop reads and writes in the region. There is one per region.
pub struct Port<'r> {
    region: &'r Region,
    ticks: RingWriter<'r>,
    requests: Receiver<'r>,
    acks: RingWriter<'r>,
    events: RingWriter<'r>,
    status: RingWriter<'r>,
    request_words: [u64; REQUEST_WORDS],
    status_words: [u64; STATUS_WORDS],
}

impl<'r> Port<'r> {
    /// The port of a region that this process created.
    #[must_use]
    pub fn new(region: &'r Region) -> Self {
        Self {
            region,
            ticks: region.tick_writer(),
            requests: region.request_receiver(),
            acks: region.ack_writer(),
            events: region.event_writer(),
            status: region.status_writer(),
            request_words: [0; REQUEST_WORDS],
            status_words: [0; STATUS_WORDS],
        }
    }

    /// Shows the front that the loop is alive.
    pub fn beat(&self, now_ns: u64) {
        let heartbeat = self.region.word(live::SERVO_HEARTBEAT);
        heartbeat.store(now_ns, Ordering::Relaxed);
    }

    /// Time since the front's last heartbeat, ns; `None` before the first.
    #[must_use]
    pub fn front_silence_ns(&self, now_ns: u64) -> Option<u64> {
        let beat_ns = self
            .region
            .word(live::FRONT_HEARTBEAT)
            .load(Ordering::Relaxed);
        (beat_ns != 0).then(|| now_ns.saturating_sub(beat_ns))
    }

    /// Says where in its life the servo is.
    pub fn set_phase(&self, phase: Phase) {
        let word = self.region.word(live::PHASE);
        word.store(phase as u64, Ordering::Release);
    }

    /// The next request: decoded, or the number of a malformed one; `None` when there is none.
    ///
    /// # Errors
    /// [`Garbled`] when the queue itself was broken; it is empty now.
    pub fn take_request(&mut self) -> Result<Option<Result<Envelope, u64>>, Garbled> {
        let length = self.requests.receive(&mut self.request_words)?;
        Ok(length.map(|length| Envelope::decode(&self.request_words[..length])))
    }

    /// Answers a request.
    pub fn acknowledge(&mut self, ack: &Ack) {
        self.acks.publish(&ack.encode());
    }

    /// Tells an event.
    pub fn tell(&mut self, event: &ServoEvent) {
        self.events.publish(&event.encode());
    }

    /// Publishes a tick.
    pub fn publish(&mut self, record: &TickRecord) {
        self.ticks.publish(&record.words());
    }

    /// Publishes the status.
    pub fn report(&mut self, status: &Status) {
        status.encode(&mut self.status_words);
        self.status.publish(&self.status_words);
    }
}
