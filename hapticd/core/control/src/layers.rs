//! Cross-fade of scenes: an edit never steps the set-point.

use crate::facing::Facings;
use crate::linear::V3;
use crate::proxy::Proxy;
use crate::scene::Scene;
use crate::supports::Supports;

/// Scenes that fade at the same time at most.
pub const MAX_LAYERS: usize = 4;

/// One scene on its way in.
#[derive(Clone, Copy, Debug)]
struct Layer {
    /// Where its scene is stored.
    slot: usize,
    /// 0 just adopted … 1 covers everything below.
    progress: f64,
    /// Progress per second; infinite for a scene that replaces at once.
    rate_hz: f64,
}

impl Layer {
    /// Share of what is below that this layer covers: a C¹ step, so that neither the force nor
    /// its rate jumps.
    fn cover(&self) -> f64 {
        let s = self.progress;
        s * s * (3.0 - 2.0 * s)
    }
}

/// The scenes in force, oldest at the bottom, each covering what is below it.
///
/// The weights are not negative and sum to one, so that a blend of set-points is never stiffer
/// than the stiffest scene.
#[derive(Clone, Debug)]
pub struct Layers {
    scenes: [Scene; MAX_LAYERS],
    /// One per scene.
    proxies: [Proxy; MAX_LAYERS],
    /// Room for their work.
    around: Supports,
    stack: [Layer; MAX_LAYERS],
    count: usize,
}

impl Default for Layers {
    fn default() -> Self {
        Self::new()
    }
}

impl Layers {
    /// The empty scene alone.
    #[must_use]
    pub fn new() -> Self {
        let bottom = Layer {
            slot: 0,
            progress: 1.0,
            rate_hz: 0.0,
        };
        Self {
            scenes: [Scene::default(); MAX_LAYERS],
            proxies: core::array::from_fn(|_| Proxy::default()),
            around: Supports::default(),
            stack: [bottom; MAX_LAYERS],
            count: 1,
        }
    }

    /// Puts a scene on top, also while others still fade. It takes over within its `fade_s`; at
    /// once where that is not positive. With [`MAX_LAYERS`] fading the lightest one gives way,
    /// whose small weight the slew limit absorbs.
    pub fn adopt(&mut self, scene: &Scene) {
        if self.count == MAX_LAYERS {
            self.drop_lightest();
        }
        let slot = self.free_slot();
        let top = self.stack[self.count - 1].slot;
        let history = self.proxies[top].history();
        let history = history.carried(self.scenes[top].walls(), scene.walls());
        self.scenes[slot] = *scene;
        self.proxies[slot].adopt(scene.walls(), history);
        let fades = scene.fade_s > 0.0;
        self.stack[self.count] = Layer {
            slot,
            progress: if fades { 0.0 } else { 1.0 },
            rate_hz: if fades { scene.fade_s.recip() } else { 0.0 },
        };
        self.count += 1;
        self.drop_covered();
    }

    /// The newest scene.
    #[must_use]
    pub fn top(&self) -> &Scene {
        &self.scenes[self.stack[self.count - 1].slot]
    }

    /// Whether more than one scene is in force.
    #[must_use]
    pub fn fading(&self) -> bool {
        self.count > 1
    }

    /// Lets the proxies start anew at the tip: it may have been taken through walls unseen.
    pub fn reset(&mut self) {
        self.proxies.iter_mut().for_each(Proxy::reset);
    }

    /// Lets `dt_s` pass.
    pub fn advance(&mut self, dt_s: f64) {
        for layer in &mut self.stack[..self.count] {
            layer.progress = (layer.progress + layer.rate_hz * dt_s).min(1.0);
        }
        self.drop_covered();
    }

    /// Lets the proxies of all scenes follow the tip to `x`, m. `soften` fills in how much of a
    /// penetration each surface lets pass.
    pub fn follow(&mut self, x: &V3, soften: impl Fn(&Scene, &mut Facings)) {
        for layer in &self.stack[..self.count] {
            let (scene, proxy) = (&self.scenes[layer.slot], &mut self.proxies[layer.slot]);
            proxy.follow(scene.walls(), x, &mut self.around);
            soften(scene, proxy.facings_mut());
        }
    }

    /// The surfaces of the newest scene that face the tip.
    #[must_use]
    pub fn top_facings(&self) -> &Facings {
        self.proxies[self.stack[self.count - 1].slot].facings()
    }

    /// The proxy of the tip in the newest scene, m.
    #[must_use]
    pub fn top_proxy(&self) -> V3 {
        self.proxies[self.stack[self.count - 1].slot].point()
    }

    /// Each scene with its weight and the surfaces that face the tip, newest first.
    pub fn weighted(&self) -> impl Iterator<Item = (f64, &Scene, &Facings)> {
        let mut uncovered = 1.0;
        self.stack[..self.count].iter().rev().map(move |layer| {
            let weight = uncovered * layer.cover();
            uncovered -= weight;
            let slot = layer.slot;
            (weight, &self.scenes[slot], self.proxies[slot].facings())
        })
    }

    /// Forgets everything below the newest layer that covers it all.
    fn drop_covered(&mut self) {
        let covers = |layer: &Layer| layer.progress >= 1.0;
        let bottom = self.stack[..self.count].iter().rposition(covers);
        let bottom = bottom.unwrap_or(0);
        self.stack.copy_within(bottom..self.count, 0);
        self.count -= bottom;
    }

    fn drop_lightest(&mut self) {
        let mut lightest = (0, f64::INFINITY);
        for (above, (weight, _, _)) in self.weighted().enumerate() {
            if weight < lightest.1 {
                lightest = (self.count - 1 - above, weight);
            }
        }
        self.stack
            .copy_within(lightest.0 + 1..self.count, lightest.0);
        self.count -= 1;
        self.stack[0].progress = 1.0;
    }

    fn free_slot(&self) -> usize {
        let used = |slot: &usize| {
            self.stack[..self.count]
                .iter()
                .any(|layer| layer.slot == *slot)
        };
        (0..MAX_LAYERS).find(|slot| !used(slot)).unwrap_or(0)
    }
}
