//! Open-loop physics of the twins: mechanics, windings, brakes, the hand, and the face to the loop.

mod hand;
mod linkage;
mod models;
mod rig;
mod twin;
mod winding;
