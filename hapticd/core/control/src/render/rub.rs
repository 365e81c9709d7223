//! The friction of the walls touched, as part of what is demanded.

use super::touch::Touch;
use crate::couple::JointDemand;
use crate::estimate::JointState;
use crate::friction::{actuator, FrictionForce, FrictionRenderer, Rubbing, MAX_RUBBING};
use crate::linear::V3;
use crate::model::DeviceModel;
use crate::scene::{Allocation, Friction};

/// Friction of one device.
#[derive(Clone, Debug)]
pub struct Rub {
    renderer: FrictionRenderer,
    brakes: bool,
}

impl Rub {
    /// Friction of `model` that has touched nothing yet, called every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            renderer: FrictionRenderer::new(model, period_s),
            brakes: model.brakes.is_some(),
        }
    }

    /// Adds the friction of the walls touched: motors give theirs whatever brakes may share, and
    /// brakes may hold with theirs.
    pub fn demand(
        &mut self,
        touches: &[Touch],
        allocation: Allocation,
        state: &JointState,
        hand_force_n: Option<&V3>,
        demand: &mut JointDemand,
    ) -> FrictionForce {
        if touches.is_empty() {
            return self.renderer.force(&[], state, hand_force_n);
        }
        let count = touches.len().min(MAX_RUBBING);
        let walls: [Rubbing; MAX_RUBBING] = core::array::from_fn(|i| match touches.get(i) {
            Some(touch) => self.rubbing(touch, allocation),
            None => Rubbing::default(),
        });
        let found = self.renderer.force(&walls[..count], state, hand_force_n);
        demand.add_motor_only(&state.jacobian, &found.motor_n);
        demand.add_hold(&state.jacobian, &found.brake_n);
        found
    }

    fn rubbing(&self, touch: &Touch, allocation: Allocation) -> Rubbing {
        Rubbing {
            key: touch.push.key,
            normal: touch.push.normal,
            normal_n: touch.push.force_n,
            friction: Friction {
                actuator: actuator(touch.friction.actuator, self.brakes, allocation),
                ..touch.friction
            },
        }
    }
}
