//! Faults that can be injected into a twin.

use crate::script::{pack, tag_of, SCRIPT_WORDS};
use serde::{Deserialize, Serialize};

/// Kinds of [`Injection`].
pub const INJECTION_KINDS: usize = 8;

/// Which fault an [`Injection`] is, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[allow(missing_docs)] // the variants are told at Injection
pub enum InjectionKind {
    Unplug,
    Silence,
    NotFinite,
    EncoderJump,
    EstopInput,
    SensorSaturated,
    AmplifierFault,
    DropFrames,
}

/// A fault of the simulated hardware that lasts a while and then heals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum Injection {
    /// The device is unplugged: exchanges are down, amplifiers are off.
    Unplug {
        /// How long, s.
        duration_s: f64,
    },
    /// No frame arrives from the device; commands still act.
    Silence {
        /// How long, s.
        duration_s: f64,
    },
    /// Measured forces and currents are NaN.
    NotFinite {
        /// How long, s.
        duration_s: f64,
    },
    /// The first encoder reads half a radian too much.
    EncoderJump {
        /// How long, s.
        duration_s: f64,
    },
    /// The E-stop input opens.
    EstopInput {
        /// How long, s.
        duration_s: f64,
    },
    /// The force sensor is at the end of its range.
    SensorSaturated {
        /// How long, s.
        duration_s: f64,
    },
    /// An amplifier reports a fault and gives nothing.
    AmplifierFault {
        /// How long, s.
        duration_s: f64,
    },
    /// Frames are lost at random.
    DropFrames {
        /// Lost share of the frames, 0 to 1.
        fraction: f64,
        /// How long, s.
        duration_s: f64,
    },
}

impl Injection {
    /// How long it lasts, s.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        match *self {
            Self::Unplug { duration_s }
            | Self::Silence { duration_s }
            | Self::NotFinite { duration_s }
            | Self::EncoderJump { duration_s }
            | Self::EstopInput { duration_s }
            | Self::SensorSaturated { duration_s }
            | Self::AmplifierFault { duration_s }
            | Self::DropFrames { duration_s, .. } => duration_s,
        }
    }

    /// Which fault it is.
    #[must_use]
    pub const fn kind(&self) -> InjectionKind {
        match self {
            Self::Unplug { .. } => InjectionKind::Unplug,
            Self::Silence { .. } => InjectionKind::Silence,
            Self::NotFinite { .. } => InjectionKind::NotFinite,
            Self::EncoderJump { .. } => InjectionKind::EncoderJump,
            Self::EstopInput { .. } => InjectionKind::EstopInput,
            Self::SensorSaturated { .. } => InjectionKind::SensorSaturated,
            Self::AmplifierFault { .. } => InjectionKind::AmplifierFault,
            Self::DropFrames { .. } => InjectionKind::DropFrames,
        }
    }

    /// Lost share of the frames while it lasts, 0 to 1.
    #[must_use]
    pub const fn fraction(&self) -> f64 {
        match *self {
            Self::DropFrames { fraction, .. } => fraction,
            _ => 0.0,
        }
    }

    /// The injection as words for shared memory: kind, duration, fraction.
    #[must_use]
    pub fn to_words(&self) -> [f64; SCRIPT_WORDS] {
        pack(
            f64::from(self.kind() as u8),
            &[self.duration_s(), self.fraction()],
        )
    }

    /// The injection in `words`; `None` when they hold no valid one.
    #[must_use]
    pub fn from_words(words: &[f64; SCRIPT_WORDS]) -> Option<Self> {
        let [kind, duration_s, fraction, ..] = *words;
        let injection = match tag_of(kind)? {
            0 => Self::Unplug { duration_s },
            1 => Self::Silence { duration_s },
            2 => Self::NotFinite { duration_s },
            3 => Self::EncoderJump { duration_s },
            4 => Self::EstopInput { duration_s },
            5 => Self::SensorSaturated { duration_s },
            6 => Self::AmplifierFault { duration_s },
            7 => Self::DropFrames {
                fraction,
                duration_s,
            },
            _ => return None,
        };
        injection.is_valid().then_some(injection)
    }

    /// Whether the duration is finite and not negative and the fraction is one.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.duration_s().is_finite()
            && self.duration_s() >= 0.0
            && (0.0..=1.0).contains(&self.fraction())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_survives_shared_memory() {
        for kind in 0..INJECTION_KINDS {
            let fraction = if kind == 7 { 0.25 } else { 0.0 };
            let words = pack(kind as f64, &[1.5, fraction]);
            let injection = Injection::from_words(&words).unwrap();
            assert_eq!(injection.kind() as usize, kind);
            assert_eq!(injection.to_words(), words);
        }
    }

    #[test]
    fn nonsense_in_shared_memory_is_no_injection() {
        for numbers in [
            [8.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.5, 1.0, 0.0],
            [1.0, f64::NAN, 0.0],
            [7.0, 1.0, 1.5],
        ] {
            assert_eq!(
                Injection::from_words(&pack(numbers[0], &numbers[1..])),
                None,
                "{numbers:?}"
            );
        }
    }

    #[test]
    fn json_is_tagged_and_strict() {
        let parsed: Injection =
            serde_json::from_str(r#"{"type": "drop_frames", "fraction": 0.1, "duration_s": 2.0}"#)
                .unwrap();
        assert_eq!(
            parsed,
            Injection::DropFrames {
                fraction: 0.1,
                duration_s: 2.0
            }
        );
        assert!(serde_json::from_str::<Injection>(
            r#"{"type": "unplug", "duration_s": 1, "how": 2}"#
        )
        .is_err());
    }
}
