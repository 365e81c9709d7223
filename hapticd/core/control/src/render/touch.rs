//! The walls that push the tip: their forces summed over the scenes in force, by the wall's key.

use crate::law::{is_damper, Push};
use crate::linear::V3;
use crate::scene::{Friction, Wall, MAX_WALLS};

/// Smallest force, N, whose direction means anything.
pub const FORCE_MIN_N: f64 = 1e-9;

/// Force of one wall on the tip by its sources, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// Of its spring.
    pub spring_n: V3,
    /// Of the damper beside the spring; into the wall where the tip leaves.
    pub damper_n: V3,
    /// Of a wall without spring.
    pub explicit_n: V3,
}

impl Parts {
    /// Adds what one surface gives in a scene of the given weight.
    pub fn add(&mut self, weight: f64, normal: &V3, surface: &Surface) {
        self.spring_n += weight * surface.spring_n * normal;
        self.damper_n += weight * surface.damper_n * normal;
        self.explicit_n += weight * surface.explicit_n * normal;
    }

    /// All of it, N, with the share of the dampers at which no wall pulls.
    #[must_use]
    pub fn force_n(&self, damper_share: f64) -> V3 {
        self.spring_n + damper_share * self.damper_n + self.explicit_n
    }
}

/// Force of one surface along its normal by its sources, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// Of its wall's spring.
    pub spring_n: f64,
    /// Of the damper beside the spring; negative where the tip leaves.
    pub damper_n: f64,
    /// Of a wall without spring.
    pub explicit_n: f64,
}

/// One wall that pushes the tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// What it asks for.
    pub push: Push,
    /// Where that comes from.
    pub parts: Parts,
    /// Whether brakes may take part.
    pub brake: bool,
    /// Whether passivity control watches it.
    pub passivity: bool,
    /// Friction on its surface, faded with the scenes.
    pub friction: Friction,
    /// Share of the scenes in which brakes may hold the tip in it.
    pub hold: f64,
}

impl Touch {
    /// The wall, untouched so far.
    #[must_use]
    pub fn of(wall: &Wall, push: Push) -> Self {
        Self {
            push,
            parts: Parts::default(),
            brake: wall.brake,
            passivity: wall.passivity,
            friction: Friction {
                actuator: wall.friction.actuator,
                ..Friction::default()
            },
            hold: 0.0,
        }
    }

    /// Counts in a scene of the given weight, where it is `wall`.
    pub fn weigh(&mut self, weight: f64, wall: &Wall) {
        self.friction.static_ += weight * wall.friction.static_;
        self.friction.kinetic += weight * wall.friction.kinetic;
        if wall.brake && is_damper(&wall.law) {
            self.hold += weight;
        }
    }

    /// Sums up its push. Beside several surfaces of one wall the force says what its normal is.
    fn settle(&mut self, damper_share: f64) {
        let force_n = self.parts.force_n(damper_share);
        let norm_n = force_n.norm();
        if norm_n > FORCE_MIN_N && force_n.dot(&self.push.normal) > 0.0 {
            self.push.normal = force_n / norm_n;
            self.push.force_n = norm_n;
        }
    }
}

/// The walls touched in one tick.
#[derive(Clone, Debug)]
pub struct Touches {
    count: usize,
    /// Those of scenes before the present one.
    older: usize,
    /// Place of the one entered last.
    last: usize,
    touches: [Touch; MAX_WALLS],
}

impl Default for Touches {
    fn default() -> Self {
        Self {
            count: 0,
            older: 0,
            last: 0,
            touches: [Touch::default(); MAX_WALLS],
        }
    }
}

impl Touches {
    /// The walls, those of the newest scene first.
    #[must_use]
    pub fn as_slice(&self) -> &[Touch] {
        &self.touches[..self.count]
    }

    /// Forgets them all.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Begins a scene, in which surfaces of one wall follow one another.
    pub fn begin(&mut self) {
        self.older = self.count;
    }

    /// The wall of `touch`, put in if it is not there; `None` once [`MAX_WALLS`] are touched.
    pub fn entry(&mut self, touch: &Touch) -> Option<&mut Touch> {
        let key = touch.push.key;
        let places = core::iter::once(self.last).chain(0..self.older);
        let known = places
            .filter(|at| *at < self.count)
            .find(|at| self.touches[*at].push.key == key);
        let at = known.unwrap_or(self.count);
        let slot = self.touches.get_mut(at)?;
        if known.is_none() {
            *slot = *touch;
            self.count += 1;
        }
        self.last = at;
        Some(slot)
    }

    /// Sums up what every wall pushes.
    pub fn settle(&mut self, damper_share: f64) {
        let touched = &mut self.touches[..self.count];
        touched
            .iter_mut()
            .for_each(|touch| touch.settle(damper_share));
    }

    /// Force of the walls that brakes may not share, N.
    #[must_use]
    pub fn motor_only_n(&self, damper_share: f64) -> V3 {
        let own = self.as_slice().iter().filter(|touch| !touch.brake);
        own.map(|touch| touch.parts.force_n(damper_share)).sum()
    }

    /// Whether brakes may share no wall's force.
    #[must_use]
    pub fn none_shared(&self) -> bool {
        !self.as_slice().iter().any(|touch| touch.brake)
    }
}
