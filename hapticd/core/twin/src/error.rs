//! Why a twin could not be built.

use core::fmt;
use hapticd_control::check::ModelError;

/// Why a twin could not be built.
#[derive(Clone, Debug, PartialEq)]
pub enum TwinError {
    /// The device model itself cannot be driven.
    Device(ModelError),
    /// Device and twin model describe different machines.
    Mismatch(&'static str),
    /// A value makes no physical sense.
    OutOfRange {
        /// Key in the `[twin]` section, or `rate_hz`.
        key: &'static str,
        /// What it was.
        value: f64,
        /// What it has to be.
        wanted: &'static str,
    },
}

impl fmt::Display for TwinError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Device(error) => write!(f, "{error}"),
            Self::Mismatch(what) => write!(f, "the twin does not fit the device: {what}"),
            Self::OutOfRange { key, value, wanted } => {
                write!(f, "twin.{key} is {value}, it has to be {wanted}")
            }
        }
    }
}

impl std::error::Error for TwinError {}
