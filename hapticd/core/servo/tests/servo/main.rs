//! The loop and its region, end to end in one process.
#![cfg(not(loom))]

mod allocation;
mod ending;
mod region;
mod requests;
mod rig;
mod ticking;
