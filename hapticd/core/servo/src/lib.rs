//! The servo: the real-time loop of one device, and the shared memory between it and the front.

pub mod ack;
pub mod cadence;
pub mod clock;
pub mod codec;
pub mod config;
pub mod document;
pub mod driver;
pub mod ending;
pub mod event;
#[cfg(not(loom))]
pub mod front;
pub mod histogram;
#[cfg(not(loom))]
pub mod layout;
pub mod lease;
pub mod mailbox;
#[cfg(not(loom))]
pub mod port;
pub mod probe;
#[cfg(not(loom))]
pub mod region;
pub mod request;
pub mod ring;
#[cfg(not(loom))]
pub mod run;
pub mod scheduling;
#[cfg(not(loom))]
pub mod servo;
pub mod status;
pub mod sync;
pub mod text;
pub mod twin_driver;
pub mod wall;
pub mod watch;
