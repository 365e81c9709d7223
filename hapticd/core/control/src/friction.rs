//! Coulomb friction with stick on the walls that the tip touches (KS §5, corrected).
//!
//! By motors, each wall holds the tip by an elastic anchor: in stick its spring balances whatever
//! pulls, up to μ_s N; past that the anchor slides and the force is μ_k N. The paper's rule,
//! min(μN, |F_hand,t|) against the hand, balances the hand but holds nothing in place, and is
//! gone when the hand lets go of a moving tip. By brakes, the torque they may give is that of
//! μN against the motion, or at rest against the hand.

mod anchor;
mod coupling;
mod heading;
mod load;

use crate::estimate::JointState;
use crate::linear::V3;
use crate::model::DeviceModel;
use crate::scene::{Allocation, Friction, FrictionActuator};
use anchor::Anchor;
use coupling::{Limits, Motion, Springs};
use heading::Heading;
use load::{shared_normal_n, HandFilter};

/// Walls that rub at the same time at most; further ones are slippery.
pub const MAX_RUBBING: usize = 16;

/// A wall that the tip touches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rubbing {
    /// The wall's number, by which it is known again.
    pub key: u64,
    /// Unit normal into free space.
    pub normal: V3,
    /// Normal force that the wall renders, N, not negative.
    pub normal_n: f64,
    /// Its friction; [`actuator`] has decided what renders it.
    pub friction: Friction,
}

/// Whether the tip sticks. The number is the one of `TickRecord::friction_state`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u64)]
pub enum FrictionState {
    /// No friction.
    #[default]
    None = 0,
    /// Every wall holds the tip.
    Stick = 1,
    /// The tip slides on a wall.
    Slip = 2,
}

/// Friction of all walls together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionForce {
    /// For the motors, N.
    pub motor_n: V3,
    /// For the brakes alone, N.
    pub brake_n: V3,
    /// Whether the tip sticks.
    pub state: FrictionState,
}

/// One wall's memory.
#[derive(Clone, Copy, Debug, Default)]
struct Memory {
    key: u64,
    anchor: Anchor,
    heading: Heading,
}

/// Friction of one device, with its memory of the walls that rub.
#[derive(Clone, Debug)]
pub struct FrictionRenderer {
    springs: Springs,
    period_s: f64,
    hand: HandFilter,
    tip_m: Option<V3>,
    memory: Box<[Memory; MAX_RUBBING]>,
    /// Of the tick before; exchanged with the present one, not copied.
    before: Box<[Memory; MAX_RUBBING]>,
    count: usize,
}

/// What renders a wall's friction: brakes where there are any unless the wall names the motors,
/// and in any case nothing that `allocation` leaves out.
#[must_use]
pub fn actuator(asked: FrictionActuator, brakes: bool, allocation: Allocation) -> FrictionActuator {
    match (brakes, allocation, asked) {
        (false, _, _) | (true, Allocation::MotorOnly, _) => FrictionActuator::Motor,
        (true, Allocation::MotorAndBrake, FrictionActuator::Motor) => FrictionActuator::Motor,
        (true, _, _) => FrictionActuator::Brake,
    }
}

impl FrictionRenderer {
    /// A renderer that has touched nothing yet, used every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            springs: Springs::new(&model.drive, period_s),
            period_s,
            hand: HandFilter::new(period_s),
            tip_m: None,
            memory: Box::new([Memory::default(); MAX_RUBBING]),
            before: Box::new([Memory::default(); MAX_RUBBING]),
            count: 0,
        }
    }

    /// Friction of the walls touched, with or without friction of their own, once a tick.
    /// `hand_force_n` is the measured force of the hand on the device, N, where there is one; it
    /// tells the normal forces then, else those that are rendered do.
    pub fn force(
        &mut self,
        rubbing: &[Rubbing],
        state: &JointState,
        hand_force_n: Option<&V3>,
    ) -> FrictionForce {
        let step_m = self.step_m(state);
        let hand_n = self.hand.follow(hand_force_n);
        if rubbing.is_empty() {
            self.count = 0;
            return FrictionForce::default();
        }
        let motion = Motion {
            step_m,
            velocity: state.xd,
            hand_n,
            coupling: self.springs.at(state),
            period_s: self.period_s,
        };
        let rubbing = &rubbing[..rubbing.len().min(MAX_RUBBING)];
        let normal_n = shared_normal_n(rubbing, motion.hand_n.as_ref());
        core::mem::swap(&mut self.memory, &mut self.before);
        let mut total = FrictionForce::default();
        for (i, rub) in rubbing.iter().enumerate() {
            self.memory[i] = self.recall(rub.key);
            add(&mut total, rub, normal_n[i], &motion, &mut self.memory[i]);
        }
        self.count = rubbing.len();
        total
    }

    /// Energy in the springs of the anchors, J: the most that friction can still give back.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        let kept = &self.memory[..self.count];
        kept.iter().map(|wall| wall.anchor.energy_j()).sum()
    }

    fn step_m(&mut self, state: &JointState) -> V3 {
        let before_m = self.tip_m.replace(state.x).unwrap_or(state.x);
        state.x - before_m
    }

    fn recall(&self, key: u64) -> Memory {
        let kept = self.before[..self.count].iter();
        let fresh = Memory {
            key,
            ..Memory::default()
        };
        kept.copied().find(|wall| wall.key == key).unwrap_or(fresh)
    }
}

/// Adds one wall's friction at a normal force of `normal_n`, N.
fn add(
    total: &mut FrictionForce,
    rub: &Rubbing,
    normal_n: f64,
    motion: &Motion,
    wall: &mut Memory,
) {
    let limits = Limits {
        static_n: rub.friction.static_ * normal_n,
        kinetic_n: rub.friction.kinetic * normal_n,
    };
    let sticks = if rub.friction.actuator == FrictionActuator::Brake {
        wall.anchor = Anchor::default();
        total.brake_n += wall.heading.force_n(&rub.normal, &limits, motion);
        wall.heading.sticks()
    } else {
        wall.heading = Heading::default();
        total.motor_n += wall.anchor.force_n(&rub.normal, &limits, motion);
        wall.anchor.sticks()
    };
    if limits.static_n > 0.0 {
        total.state = total.state.max(if sticks {
            FrictionState::Stick
        } else {
            FrictionState::Slip
        });
    }
}
