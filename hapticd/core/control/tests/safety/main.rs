//! The safety layer, from single formulas to the eight laws over the whole tick.

mod absences;
mod actuator;
mod allocate;
mod bound;
mod brake;
mod brakes_at_work;
mod budget;
mod check;
mod checker;
mod friction_at_work;
mod gain;
mod grip;
mod laws;
mod machine;
mod models;
mod outputs;
mod passivity;
mod plant;
mod plausibility;
mod rendering;
mod rig;
mod thermal;
mod ticks;
