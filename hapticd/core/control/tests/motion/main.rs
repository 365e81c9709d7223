//! Property tests of everything from counts to joint demand.

mod chai3d;
mod contact;
mod couple;
mod edits;
mod environment;
mod estimate;
mod kinematics;
mod layers;
mod linear;
mod mapping;
mod models;
mod proxy;
mod resting;
mod solids;
mod walls;
