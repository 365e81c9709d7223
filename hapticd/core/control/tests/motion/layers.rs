use hapticd_control::layers::{Layers, MAX_LAYERS};
use hapticd_control::scene::Scene;
use proptest::prelude::*;

const TICK_S: f64 = 1e-3;

fn scene(revision: u64, fade_s: f64) -> Scene {
    Scene {
        revision,
        fade_s,
        ..Scene::default()
    }
}

fn weight_of(layers: &Layers, revision: u64) -> f64 {
    let own = layers
        .weighted()
        .filter(|(_, scene, _)| scene.revision == revision);
    own.map(|(weight, ..)| weight).sum()
}

/// Ticks to let pass, then an edit with a fade of that many ticks.
fn edits() -> impl Strategy<Value = Vec<(usize, f64)>> {
    prop::collection::vec((0..120_usize, 0.0..0.3_f64), 1..12)
}

proptest! {
    #[test]
    fn weights_are_a_partition_of_one_whatever_the_edits(edits in edits()) {
        let mut layers = Layers::new();
        for (revision, (ticks, fade_s)) in (1..).zip(&edits) {
            layers.adopt(&scene(revision, *fade_s));
            prop_assert_eq!(layers.top().revision, revision);
            for _ in 0..*ticks {
                layers.advance(TICK_S);
                let total: f64 = layers.weighted().map(|(weight, ..)| weight).sum();
                prop_assert!((total - 1.0).abs() < 1e-12);
                prop_assert!(layers.weighted().all(|(weight, ..)| weight >= 0.0));
                prop_assert!(layers.weighted().count() <= MAX_LAYERS);
            }
        }
    }

    #[test]
    fn last_edit_is_in_force_alone_after_its_fade(edits in edits()) {
        let mut layers = Layers::new();
        for (revision, (ticks, fade_s)) in (1..).zip(&edits) {
            layers.adopt(&scene(revision, *fade_s));
            (0..*ticks).for_each(|_| layers.advance(TICK_S));
        }
        (0..301).for_each(|_| layers.advance(TICK_S));
        prop_assert!(!layers.fading());
        prop_assert_eq!(weight_of(&layers, edits.len() as u64), 1.0);
    }

    #[test]
    fn adopting_changes_no_weight_while_there_is_room(ticks in 1..90_usize) {
        let mut layers = Layers::new();
        for revision in 1..MAX_LAYERS as u64 {
            let before: Vec<f64> = (0..revision).map(|old| weight_of(&layers, old)).collect();
            layers.adopt(&scene(revision, 0.3));
            let after: Vec<f64> = (0..revision).map(|old| weight_of(&layers, old)).collect();
            prop_assert_eq!(before, after);
            prop_assert_eq!(weight_of(&layers, revision), 0.0);
            (0..ticks).for_each(|_| layers.advance(TICK_S));
        }
    }

    #[test]
    fn fade_starts_and_ends_without_a_step_in_its_rate(fade_s in 0.05..0.5_f64) {
        let mut layers = Layers::new();
        layers.adopt(&scene(1, fade_s));
        let (mut weight, mut rate) = (0.0, 0.0);
        while layers.fading() {
            layers.advance(TICK_S);
            let next = weight_of(&layers, 1);
            let next_rate = (next - weight) / TICK_S;
            // Largest second derivative of the smooth step.
            prop_assert!((next_rate - rate).abs() <= 6.0 * TICK_S / fade_s.powi(2) + 1e-9);
            (weight, rate) = (next, next_rate);
        }
        prop_assert!(rate <= 6.0 * TICK_S / fade_s.powi(2));
    }
}

#[test]
fn storm_of_edits_loses_only_the_lightest_and_still_moves_on() {
    let mut layers = Layers::new();
    for revision in 1..100 {
        let before: Vec<(f64, u64)> = layers.weighted().map(|(w, s, _)| (w, s.revision)).collect();
        let lightest = before.iter().map(|(w, _)| *w).fold(f64::INFINITY, f64::min);
        layers.adopt(&scene(revision, 0.2));
        let kept = |(weight, old): &(f64, u64)| (weight_of(&layers, *old) - weight).abs();
        let step = before.iter().map(kept).fold(0.0, f64::max);
        assert!(step <= lightest + 1e-12);
        (0..16).for_each(|_| layers.advance(TICK_S));
    }
    assert_eq!(weight_of(&layers, 0), 0.0);
}

#[test]
fn edit_without_fade_replaces_everything_at_once() {
    let mut layers = Layers::new();
    layers.adopt(&scene(1, 0.2));
    layers.advance(0.1);
    for fade_s in [0.0, -1.0, f64::NAN] {
        layers.adopt(&scene(2, fade_s));
        assert!(!layers.fading());
        assert_eq!(weight_of(&layers, 2), 1.0);
    }
}

#[test]
fn nothing_is_rendered_before_the_first_scene() {
    let layers = Layers::new();
    assert_eq!((layers.top().count, layers.fading()), (0, false));
}
