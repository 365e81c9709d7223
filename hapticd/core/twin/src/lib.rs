//! The twins of hapticd: plants of both devices with the operator's hand. Same seed, same run.
//! No I/O, no allocation in a step, no clock of its own.

pub mod brake;
mod check;
pub mod delay;
pub mod error;
pub mod friction;
pub mod hand;
pub mod hhd;
pub mod impairment;
pub mod injection;
pub mod intention;
pub mod linkage;
pub mod mechanics;
pub mod model;
pub mod motor;
pub mod noise;
pub mod phantom;
pub mod plant;
pub mod script;
pub mod sensor;
pub mod stops;
pub mod truth;
pub mod twin;
pub mod winding;

pub use error::TwinError;
pub use injection::Injection;
pub use model::TwinModel;
pub use script::Script;
pub use truth::Truth;
pub use twin::Twin;
