//! The safety layer, from single formulas to the eight laws over the whole tick.

mod checker;
mod laws;
mod machine;
mod models;
mod rendering;
mod rig;
