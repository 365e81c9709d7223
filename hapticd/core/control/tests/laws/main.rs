//! How walls answer: each law by itself, scenes of any walls, brakes that hold, the probe.

mod held;
#[allow(dead_code)] // shared with the safety tests
#[path = "../safety/models.rs"]
mod models;
mod probe;
mod push;
#[allow(dead_code)] // shared with the safety tests
#[path = "../safety/rig.rs"]
mod rig;
mod scenes;
