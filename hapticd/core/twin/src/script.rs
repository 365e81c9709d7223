//! What the operator's hand is told to do.

use hapticd_control::io::Axes;
use hapticd_control::linear::V3;
use serde::{Deserialize, Serialize};

/// Words of a [`Script`] or an [`Injection`](crate::Injection) in shared memory.
pub const SCRIPT_WORDS: usize = 16;

/// Speed at which [`Script::Push`] advances when none is given, m/s.
const PUSH_SPEED_M_PER_S: f64 = 0.1;

/// The operator's task. Positions are in the base frame, m; a two-joint device keeps z at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "type", rename_all = "snake_case")]
pub enum Script {
    /// The hand is off the device.
    #[default]
    Free,
    /// The hand stays where it is.
    Hold {
        /// Braced: the arm's stiffness and damping are raised by the model's `brace` factor.
        #[serde(default)]
        stiff: bool,
    },
    /// The intention is led smoothly to a point and follows it when it moves.
    Follow {
        /// The point, m.
        target_m: Axes,
    },
    /// The intention advances along a line until the hand pushes with a force.
    Push {
        /// Direction of the push; any length but zero.
        direction: Axes,
        /// Force of the arm in equilibrium, N.
        force_n: f64,
        /// Speed of the advance, m/s.
        #[serde(default = "push_speed_m_per_s")]
        speed_m_per_s: f64,
    },
    /// The intention swings sinusoidally about a point.
    Stroke {
        /// The point, m.
        center_m: Axes,
        /// Direction of the stroke; any length but zero.
        axis: Axes,
        /// Half the stroke, m.
        amplitude_m: f64,
        /// Strokes per second, Hz.
        frequency_hz: f64,
    },
    /// The intention is led to a point and leaves it on a minimum-jerk path to another.
    MinimumJerk {
        /// Start, m.
        from_m: Axes,
        /// End, m.
        to_m: Axes,
        /// Duration of the path, s.
        duration_s: f64,
    },
    /// No hand: a bench clamp takes the tip to a point and holds it there, stiff to the ground.
    Clamp {
        /// The point, m.
        position_m: Axes,
    },
}

const fn push_speed_m_per_s() -> f64 {
    PUSH_SPEED_M_PER_S
}

impl Script {
    /// The script as words for shared memory: a tag, then its numbers in declaration order.
    #[must_use]
    pub fn to_words(&self) -> [f64; SCRIPT_WORDS] {
        match *self {
            Self::Free => pack(0.0, &[]),
            Self::Hold { stiff } => pack(1.0, &[f64::from(u8::from(stiff))]),
            Self::Follow { target_m: t } => pack(2.0, &t),
            Self::Push {
                direction: d,
                force_n,
                speed_m_per_s,
            } => pack(3.0, &[d[0], d[1], d[2], force_n, speed_m_per_s]),
            Self::Stroke {
                center_m: c,
                axis: a,
                amplitude_m,
                frequency_hz,
            } => pack(
                4.0,
                &[
                    c[0],
                    c[1],
                    c[2],
                    a[0],
                    a[1],
                    a[2],
                    amplitude_m,
                    frequency_hz,
                ],
            ),
            Self::MinimumJerk {
                from_m: f,
                to_m: t,
                duration_s,
            } => pack(5.0, &[f[0], f[1], f[2], t[0], t[1], t[2], duration_s]),
            Self::Clamp { position_m: p } => pack(6.0, &p),
        }
    }

    /// The script in `words`; `None` when they hold no valid script.
    #[must_use]
    pub fn from_words(words: &[f64; SCRIPT_WORDS]) -> Option<Self> {
        let [tag, a, b, c, d, e, f, g, h, ..] = *words;
        let script = match tag_of(tag)? {
            0 => Self::Free,
            1 => Self::Hold { stiff: a != 0.0 },
            2 => Self::Follow {
                target_m: [a, b, c],
            },
            3 => Self::Push {
                direction: [a, b, c],
                force_n: d,
                speed_m_per_s: e,
            },
            4 => Self::Stroke {
                center_m: [a, b, c],
                axis: [d, e, f],
                amplitude_m: g,
                frequency_hz: h,
            },
            5 => Self::MinimumJerk {
                from_m: [a, b, c],
                to_m: [d, e, f],
                duration_s: g,
            },
            6 => Self::Clamp {
                position_m: [a, b, c],
            },
            _ => return None,
        };
        script.is_valid().then_some(script)
    }

    /// Whether every number is finite, every direction has a length and every rate has its sign.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let numbers_valid = match *self {
            Self::Push {
                direction,
                force_n,
                speed_m_per_s,
            } => has_length(&direction) && force_n >= 0.0 && speed_m_per_s > 0.0,
            Self::Stroke {
                axis, frequency_hz, ..
            } => has_length(&axis) && frequency_hz >= 0.0,
            Self::MinimumJerk { duration_s, .. } => duration_s > 0.0,
            _ => true,
        };
        numbers_valid && self.to_words().iter().all(|word| word.is_finite())
    }

    /// The script with every vector kept to the coordinates where `mask` is 1 and not 0.
    #[must_use]
    pub(crate) fn within(mut self, mask: &V3) -> Self {
        let keep = |v: &mut Axes| *v = core::array::from_fn(|i| v[i] * mask[i]);
        match &mut self {
            Self::Free | Self::Hold { .. } => {}
            Self::Follow { target_m } => keep(target_m),
            Self::Push { direction, .. } => keep(direction),
            Self::Stroke { center_m, axis, .. } => {
                keep(center_m);
                keep(axis);
            }
            Self::MinimumJerk { from_m, to_m, .. } => {
                keep(from_m);
                keep(to_m);
            }
            Self::Clamp { position_m } => keep(position_m),
        }
        self
    }
}

fn has_length(direction: &Axes) -> bool {
    direction.iter().map(|d| d * d).sum::<f64>() > 1e-18
}

/// Tag and numbers, padded with zeros.
pub(crate) fn pack(tag: f64, numbers: &[f64]) -> [f64; SCRIPT_WORDS] {
    let mut words = [0.0; SCRIPT_WORDS];
    words[0] = tag;
    words[1..=numbers.len()].copy_from_slice(numbers);
    words
}

/// The tag as a small integer; `None` when it is not one.
pub(crate) fn tag_of(word: f64) -> Option<u8> {
    (0..=u8::MAX).find(|tag| f64::from(*tag) == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCRIPTS: [Script; 8] = [
        Script::Free,
        Script::Hold { stiff: false },
        Script::Hold { stiff: true },
        Script::Follow {
            target_m: [0.1, 0.2, 0.3],
        },
        Script::Push {
            direction: [0.0, -1.0, 0.0],
            force_n: 5.0,
            speed_m_per_s: 0.2,
        },
        Script::Stroke {
            center_m: [0.1, 0.2, 0.3],
            axis: [1.0, 0.0, 2.0],
            amplitude_m: 0.02,
            frequency_hz: 2.0,
        },
        Script::MinimumJerk {
            from_m: [0.1, 0.2, 0.3],
            to_m: [0.4, 0.5, 0.6],
            duration_s: 0.75,
        },
        Script::Clamp {
            position_m: [0.1, 0.2, 0.3],
        },
    ];

    #[test]
    fn every_script_survives_shared_memory_and_json() {
        for script in SCRIPTS {
            assert_eq!(Script::from_words(&script.to_words()), Some(script));
            let json = serde_json::to_string(&script).unwrap();
            assert_eq!(serde_json::from_str::<Script>(&json).unwrap(), script);
        }
    }

    #[test]
    fn nonsense_in_shared_memory_is_no_script() {
        let invalid = [
            pack(7.0, &[]),
            pack(-1.0, &[]),
            pack(f64::NAN, &[]),
            pack(2.0, &[f64::INFINITY, 0.0, 0.0]),
            pack(3.0, &[0.0, 0.0, 0.0, 5.0, 0.1]),
            pack(3.0, &[1.0, 0.0, 0.0, 5.0, 0.0]),
            pack(5.0, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        ];
        for words in invalid {
            assert_eq!(Script::from_words(&words), None, "{words:?}");
        }
    }

    #[test]
    fn an_unknown_field_of_a_script_is_refused() {
        let json = r#"{"type": "follow", "target_m": [0, 0, 0], "speed": 1}"#;
        assert!(serde_json::from_str::<Script>(json).is_err());
    }
}
