//! A scene's probe as words, and whether its numbers make sense.

use crate::codec::{Decoder, Encoder};
use crate::wall::{is_size, is_unit};
use hapticd_control::scene::Probe;

/// Words of a probe: whether there is one, direction, amplitude, frequency.
pub const PROBE_WORDS: usize = 6;

/// Whether every number makes sense. Written so that a NaN fails.
#[must_use]
pub fn is_valid(probe: &Probe) -> bool {
    is_unit(&probe.direction) && is_size(probe.amplitude_m) && is_size(probe.frequency_hz)
}

/// Writes a probe, or that there is none.
pub fn encode(probe: Option<&Probe>, encoder: &mut Encoder<'_>) {
    let still = Probe {
        direction: [0.0; 3],
        amplitude_m: 0.0,
        frequency_hz: 0.0,
    };
    let Probe {
        direction,
        amplitude_m,
        frequency_hz,
    } = probe.unwrap_or(&still);
    encoder
        .word(u64::from(probe.is_some()))
        .numbers(direction)
        .number(*amplitude_m)
        .number(*frequency_hz);
}

/// Reads a probe; outer `None` where the words hold none and do not say so.
pub fn decode(decoder: &mut Decoder<'_>) -> Option<Option<Probe>> {
    let present = decoder.word()?;
    let probe = Probe {
        direction: decoder.axes()?,
        amplitude_m: decoder.number()?,
        frequency_hz: decoder.number()?,
    };
    (present <= 1).then(|| (present == 1).then_some(probe))
}
