//! Where everything lies in the shared region, in 8-byte words. The prose is docs/shared-memory.md.

use crate::ack::ACK_WORDS;
use crate::event::EVENT_WORDS;
use crate::mailbox::mailbox_words;
use crate::request::REQUEST_WORDS;
use crate::ring::ring_words;
use crate::status::STATUS_WORDS;
use hapticd_control::record::{Kind, FIELDS, RECORD_WORDS};
use std::ops::Range;

/// First word: `hapticd` and a zero byte, in the machine's byte order.
pub const MAGIC: u64 = u64::from_ne_bytes(*b"hapticd\0");
/// Changes whenever a word moves or changes its meaning.
pub const VERSION: u64 = 1;

/// The ring holds at least this much, s.
const RING_S: f64 = 4.0;
/// Records beyond that, so that a reader 4 s behind is not overtaken while it copies.
const RING_SPARE: usize = 64;
/// Acks kept.
const ACKS: usize = 256;
/// Events kept.
const EVENTS: usize = 1024;
/// Status blocks kept: a reader of the newest is lapped after three more.
const STATUSES: usize = 4;
/// Room for requests, words: six scenes of the largest size.
const REQUEST_QUEUE_WORDS: usize = 6 * (REQUEST_WORDS + 1);

/// Words of a text in the header and of the device's identity.
pub const TEXT_WORDS: usize = 32;

/// Words of the header that never change after the region is published.
pub(crate) mod header {
    use std::ops::Range;

    pub const MAGIC: usize = 0;
    pub const VERSION: usize = 1;
    pub const SCHEMA: usize = 2;
    pub const TICK_CAPACITY: usize = 3;
    pub const RATE: usize = 4;
    pub const PID: usize = 5;
    pub const STARTED_UTC_NS: usize = 6;
    pub const STARTED_MONO_NS: usize = 7;
    pub const BOOT_ID: Range<usize> = 8..10;
    pub const TWIN: usize = 10;
    pub const DEVICE_ID: Range<usize> = 16..16 + super::TEXT_WORDS;
}

/// Words that one side stores and the other loads, each side on a cache line of its own.
pub(crate) mod live {
    /// Servo: `CLOCK_MONOTONIC` of the last tick, ns.
    pub const SERVO_HEARTBEAT: usize = 64;
    /// Servo: [`Phase`](crate::status::Phase).
    pub const PHASE: usize = 65;
    /// Front: `CLOCK_MONOTONIC` of its last heartbeat, ns; 0 before the first.
    pub const FRONT_HEARTBEAT: usize = 72;
    /// Front: its process id.
    pub const FRONT_PID: usize = 73;
    /// Front: number of the last request it sent.
    pub const LAST_REQUEST: usize = 74;
}

const HEADER_WORDS: usize = 80;

const _: () = assert!(header::DEVICE_ID.end <= live::SERVO_HEARTBEAT);

/// Word ranges of the sections, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Records the tick ring holds.
    pub tick_capacity: usize,
    /// Ring of tick records.
    pub ticks: Range<usize>,
    /// Mailbox of requests.
    pub requests: Range<usize>,
    /// Ring of acks.
    pub acks: Range<usize>,
    /// Ring of events.
    pub events: Range<usize>,
    /// Ring of status blocks.
    pub status: Range<usize>,
    /// Ring of the device's identity, written when it connects.
    pub identity: Range<usize>,
    /// All words.
    pub words: usize,
}

impl Layout {
    /// The layout for a loop of `rate_hz`.
    #[must_use]
    pub fn for_rate(rate_hz: f64) -> Self {
        Self::new((RING_S * rate_hz).ceil() as usize + RING_SPARE)
    }

    /// The layout with a tick ring of `tick_capacity` records.
    #[must_use]
    pub fn new(tick_capacity: usize) -> Self {
        let mut at = HEADER_WORDS;
        let mut take = |words: usize| {
            // Each section starts a cache line.
            let start = at.next_multiple_of(8);
            at = start + words;
            start..at
        };
        Self {
            tick_capacity,
            ticks: take(ring_words(tick_capacity, RECORD_WORDS)),
            requests: take(mailbox_words(REQUEST_QUEUE_WORDS)),
            acks: take(ring_words(ACKS, ACK_WORDS)),
            events: take(ring_words(EVENTS, EVENT_WORDS)),
            status: take(ring_words(STATUSES, STATUS_WORDS)),
            identity: take(ring_words(STATUSES, TEXT_WORDS)),
            words: at,
        }
    }
}

/// FNV-1a over names, types and sizes of the tick record's fields: two builds with the same hash
/// read each other's ticks.
#[must_use]
pub fn schema_hash() -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut mix = |byte: u8| hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    for field in FIELDS {
        field.name.bytes().for_each(&mut mix);
        mix(match field.kind {
            Kind::Float => b'f',
            Kind::Unsigned => b'u',
        });
        mix(field.words as u8);
    }
    hash
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ring_holds_four_seconds_at_every_rate() {
        for rate_hz in [500.0, 1000.0, 1333.3, 4000.0, 10_000.0] {
            let layout = Layout::for_rate(rate_hz);
            assert!(layout.tick_capacity as f64 / rate_hz >= RING_S);
        }
    }

    #[test]
    fn sections_follow_each_other_on_cache_lines_without_overlap() {
        let layout = Layout::for_rate(1000.0);
        let sections = [
            &layout.ticks,
            &layout.requests,
            &layout.acks,
            &layout.events,
            &layout.status,
            &layout.identity,
        ];
        let mut end = HEADER_WORDS;
        for section in sections {
            assert!(section.start >= end && section.start % 8 == 0);
            end = section.end;
        }
        assert_eq!(end, layout.words);
    }
}
