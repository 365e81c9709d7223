//! The control core of hapticd: observation → estimate → contact → environment → couple →
//! allocate → bound → command. Pure functions over fixed-size values: no I/O, no allocation
//! in a tick, no clock of its own.

pub mod fault;
pub mod io;
pub mod model;
pub mod record;
pub mod scene;
