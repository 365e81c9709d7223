//! The operator: a two-mass hand, a bench clamp, or nobody.

use crate::intention::Intention;
use crate::model::HandModel;
use crate::script::Script;
use hapticd_control::linear::V3;

/// The operator's hand on the tip. The grip's force is what a force sensor at the handle reads.
#[derive(Clone, Copy, Debug)]
pub struct Hand {
    model: HandModel,
    script: Script,
    intention: Intention,
    /// Coordinates the device has: 1, else 0.
    plane: V3,
    /// Hand and forearm x_a, m; the tip when nobody holds it.
    position: V3,
    velocity: V3,
    /// Force of the hand on the device, N.
    force: V3,
}

impl Hand {
    /// Nobody at `tip` (m) of a device with `dof` coordinates.
    #[must_use]
    pub fn new(model: &HandModel, tip: V3, dof: usize) -> Self {
        Self {
            model: *model,
            script: Script::Free,
            intention: Intention::new(Script::Free, tip),
            plane: V3::from_fn(|i, _| if i < dof { 1.0 } else { 0.0 }),
            position: tip,
            velocity: V3::zeros(),
            force: V3::zeros(),
        }
    }

    /// Begins a script where the hand is now; an invalid one is ignored.
    pub fn begin(&mut self, script: Script) {
        let script = script.within(&self.plane);
        if script.is_valid() {
            self.script = script;
            self.intention = Intention::new(script, self.position);
        }
    }

    /// Where the hand is, m.
    #[must_use]
    pub fn position(&self) -> V3 {
        self.position
    }

    /// Force of the hand on the device, N.
    #[must_use]
    pub fn force(&self) -> V3 {
        self.force
    }

    /// One step of `h` (s) beside a tip at `tip` (m) moving with `tip_velocity` (m/s).
    /// Returns the force of the hand on the device, N.
    pub fn step(&mut self, tip: &V3, tip_velocity: &V3, h: f64) -> V3 {
        self.force = match self.script {
            Script::Free => self.let_go(tip, tip_velocity),
            Script::Clamp { .. } => self.clamp(tip, tip_velocity, h),
            Script::Hold { stiff: true } => self.grip(tip, tip_velocity, self.model.brace, h),
            _ => self.grip(tip, tip_velocity, 1.0, h),
        };
        self.force
    }

    fn let_go(&mut self, tip: &V3, tip_velocity: &V3) -> V3 {
        self.position = *tip;
        self.velocity = *tip_velocity;
        V3::zeros()
    }

    fn clamp(&mut self, tip: &V3, tip_velocity: &V3, h: f64) -> V3 {
        let m = &self.model;
        self.intention.advance(m, tip, m.clamp_stiffness_n_per_m, h);
        let i = &self.intention;
        self.position = i.position;
        self.velocity = i.velocity;
        (i.position - tip) * m.clamp_stiffness_n_per_m
            + (i.velocity - tip_velocity) * m.clamp_damping_n_s_per_m
    }

    /// Two masses (KS Figs. 8 and 9 need both): tip and hand joined by the grip, hand and
    /// intention by the arm, whose stiffness and damping are `brace` times the model's.
    fn grip(&mut self, tip: &V3, tip_velocity: &V3, brace: f64, h: f64) -> V3 {
        let m = &self.model;
        let (k_a, b_a) = (
            m.arm_stiffness_n_per_m * brace,
            m.arm_damping_n_s_per_m * brace,
        );
        self.intention.advance(m, &self.position, k_a, h);
        let grip = (self.position - tip) * m.grip_stiffness_n_per_m
            + (self.velocity - tip_velocity) * m.grip_damping_n_s_per_m;
        let arm = (self.intention.position - self.position) * k_a
            + (self.intention.velocity - self.velocity) * b_a;
        let arm = arm.cap_magnitude(m.arm_force_max_n);
        self.velocity += (arm - grip) * (h / m.mass_kg);
        self.position += self.velocity * h;
        grip
    }
}
