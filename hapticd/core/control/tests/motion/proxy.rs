use crate::solids::*;
use hapticd_control::linear::V3;
use hapticd_control::scene::Shape;
use proptest::prelude::*;

/// Somewhere no random shape reaches.
const AWAY: V3 = V3::new(0.4, 0.3, 0.0);

fn scene(flat: bool) -> impl Strategy<Value = Vec<Shape>> {
    let shape = prop_oneof![
        1 => plane(flat),
        4 => any_shape(flat, false),
        2 => any_shape(flat, true),
    ];
    prop::collection::vec(shape, 1..12)
}

fn way(flat: bool) -> impl Strategy<Value = Vec<V3>> {
    prop::collection::vec(point(flat, 0.15), 1..30)
}

fn scene_and_way() -> impl Strategy<Value = (bool, Vec<Shape>, Vec<V3>)> {
    any::<bool>().prop_flat_map(|flat| (Just(flat), scene(flat), way(flat)))
}

/// The tip goes to each place in `steps` ticks.
fn drive(
    hand: &mut Hand,
    from: V3,
    way: &[V3],
    steps: usize,
    mut each: impl FnMut(&Hand, &V3, V3),
) {
    let mut last = from;
    for place in way {
        for step in 1..=steps {
            let x = last.lerp(place, step as f64 / steps as f64);
            let p = hand.to(&x);
            each(hand, &x, p);
        }
        last = *place;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn proxy_never_changes_side_however_fast_the_tip(
        (flat, shapes, way) in scene_and_way(), steps in 1..20_usize,
    ) {
        let away = within(flat, AWAY);
        let planes_keep_away = shapes.iter().all(|shape| distance_m(shape, &away) > 0.0);
        prop_assume!(planes_keep_away);
        let mut hand = Hand::among(&shapes);
        hand.to(&away);
        drive(&mut hand, away, &way, steps, |hand, x, p| {
            let least_m = hand.distances_m().into_iter().fold(f64::INFINITY, f64::min);
            assert!(least_m > 0.0, "{least_m} at {x} with the proxy at {p}");
            assert!(!flat || p.z == 0.0, "the proxy left the plane");
        });
    }
}
