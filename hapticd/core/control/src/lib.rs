//! The control core of hapticd: observation → estimate → contact → environment → couple →
//! allocate → bound → command. Pure functions over fixed-size values: no I/O, no allocation
//! in a tick, no clock of its own.

pub mod actuator;
pub mod allocate;
pub mod bits;
pub mod bound;
pub mod brake;
pub mod braking;
pub mod budget;
pub mod check;
pub mod contact;
pub mod controller;
pub mod couple;
pub mod damping;
pub mod environment;
pub mod estimate;
pub mod facing;
pub mod fault;
pub mod friction;
pub mod gain;
pub mod guard;
pub mod hold;
pub mod interlock;
pub mod io;
pub mod kinematics;
pub mod law;
pub mod layers;
pub mod linear;
pub mod mapping;
pub mod model;
pub mod outputs;
pub mod plausibility;
pub mod proxy;
pub mod publish;
pub mod record;
pub mod render;
pub mod scene;
pub mod stage;
pub mod state;
pub mod thermal;
