//! The servo: the real-time loop of one device, and the shared memory between it and the front.

pub mod ack;
pub mod cadence;
pub mod clock;
pub mod codec;
pub mod document;
pub mod driver;
pub mod event;
pub mod histogram;
pub mod layout;
pub mod mailbox;
#[cfg(not(loom))]
pub mod region;
pub mod request;
pub mod ring;
pub mod scheduling;
pub mod status;
pub mod sync;
pub mod text;
pub mod twin_driver;
