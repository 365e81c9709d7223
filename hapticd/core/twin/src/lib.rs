//! The twins of hapticd: closed-form plants of both devices with the operator's hand.
//! Same seed, same run. No I/O, no allocation in a step, no clock of its own.

pub mod error;
pub mod injection;
pub mod model;
pub mod script;
pub mod truth;
pub mod twin;

pub use error::TwinError;
pub use injection::Injection;
pub use model::TwinModel;
pub use script::Script;
pub use truth::Truth;
pub use twin::Twin;
