//! Friction on walls: single walls over random paths, several at a time, and in closed loop.

mod bounds;
mod brakes;
mod edits;
mod energy;
mod normal_force;
mod rubber;
mod slider;
