//! Where the proxy rests is the closest free point, and its facings say so.

use crate::solids::*;
use hapticd_control::environment::set_point;
use hapticd_control::facing::Facing;
use hapticd_control::linear::V3;
use hapticd_control::scene::Shape;
use proptest::prelude::*;

const AWAY: V3 = V3::new(0.4, 0.3, 0.0);

/// Where rigid walls with the facings of the hand want the tip, m.
fn held(hand: &Hand, x: &V3) -> V3 {
    let rigid = |facing: &Facing| Facing {
        eta: 0.0,
        ..*facing
    };
    let facings: Vec<Facing> = hand.facings().iter().map(rigid).collect();
    set_point(&facings, x, &V3::zeros()).x_sd
}

/// Convex free space around the origin: planes and the cavities of shells.
fn room(flat: bool) -> impl Strategy<Value = Vec<Shape>> {
    let shell = any_shape(flat, true).prop_filter("without the origin", |shape| {
        distance_m(shape, &V3::zeros()) < -1e-3
    });
    prop::collection::vec(prop_oneof![plane(flat), shell], 1..5)
}

fn room_and_points() -> impl Strategy<Value = (bool, Vec<Shape>, V3, V3)> {
    any::<bool>().prop_flat_map(|flat| (Just(flat), room(flat), point(flat, 0.1), point(flat, 0.1)))
}

/// The farthest free point from the origin towards `aim`, m.
fn farthest(room: &[Shape], aim: &V3) -> V3 {
    let free = |y: &V3| {
        room.iter().all(|shape| match shape {
            Shape::Plane { .. } => distance_m(shape, y) >= 0.0,
            _ => distance_m(shape, y) <= 0.0,
        })
    };
    let (mut inside, mut outside) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (inside + outside);
        if free(&(middle * aim)) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside * aim
}

fn scene_and_way() -> impl Strategy<Value = (bool, Vec<Shape>, Vec<V3>)> {
    any::<bool>().prop_flat_map(|flat| {
        let shapes = prop::collection::vec(any_shape(flat, false), 1..6);
        (
            Just(flat),
            shapes,
            prop::collection::vec(point(flat, 0.12), 1..6),
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// p is the closest point of a convex room exactly when (x − p)·(y − p) ≤ 0 for all y in it.
    #[test]
    fn proxy_in_a_room_is_the_closest_point(
        (_, room, x, _) in room_and_points(), aims in prop::collection::vec(point(false, 0.3), 64),
    ) {
        let mut hand = Hand::among(&room);
        hand.to(&V3::zeros());
        let p = hand.settle(&x);
        for aim in aims {
            let y = farthest(&room, &within(x.z == 0.0, aim));
            prop_assert!((x - p).dot(&(y - p)) < 1e-6, "{} is closer than {}", y, p);
        }
        // Where a round cavity meets a plane, a nanometre of clearance is micrometres along it.
        prop_assert!((held(&hand, &x) - p).norm() < 1e-4);
    }

    #[test]
    fn proxy_in_a_room_moves_no_farther_than_the_tip((_, room, a, b) in room_and_points()) {
        let mut hand = Hand::among(&room);
        hand.to(&V3::zeros());
        let change_m = (hand.settle(&a) - hand.settle(&b)).norm();
        prop_assert!(change_m <= (a - b).norm() + 6e-5);
    }

    #[test]
    fn rigid_facings_hold_the_tip_at_the_proxy((flat, shapes, way) in scene_and_way()) {
        let mut hand = Hand::among(&shapes);
        hand.to(&within(flat, AWAY));
        for x in way {
            let p = hand.settle(&x);
            prop_assert!((held(&hand, &x) - p).norm() < 1e-5, "{} {}", p, held(&hand, &x));
        }
    }

    #[test]
    fn ball_is_met_along_its_radius(u in point(false, 1.0), depth in 0.0..0.6_f64) {
        prop_assume!(u.norm() > 0.1);
        let (u, center) = (u.normalize(), V3::new(0.01, -0.02, 0.03));
        let ball = Shape::Sphere { center_m: center.into(), radius_m: 0.04, hollow: false };
        let mut hand = Hand::among(&[ball]);
        hand.to(&(center + 0.05 * V3::new(-u.y, u.x, u.z + 0.3)));
        let x = center + 0.04 * (1.0 - depth) * u;
        let p = hand.settle(&x);
        prop_assume!((p - center).dot(&u) > 0.0);
        prop_assert!((p - (center + 0.04 * u)).norm() < 1e-8);
    }
}

fn block(center_m: [f64; 3], half_m: [f64; 3], hollow: bool) -> Shape {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Shape::Box {
        center_m,
        axes,
        half_m,
        hollow,
    }
}

fn assert_near(a: V3, b: V3) {
    assert!((a - b).norm() < 1e-8, "{a} is not {b}");
}

#[test]
fn tip_pushed_deep_and_then_past_the_edge_is_let_go() {
    let mut hand = Hand::among(&[block([0.0; 3], [0.02; 3], false)]);
    for step in 0..40 {
        hand.to(&V3::new(0.0, 0.0, 0.03 - 0.001 * f64::from(step)));
    }
    for step in 0..19 {
        let x = 0.001 * f64::from(step);
        assert_near(hand.to(&V3::new(x, 0.0, -0.01)), V3::new(x, 0.0, 0.02));
    }
    let beyond = V3::new(0.0205, 0.0, -0.01);
    assert_eq!(hand.settle(&beyond), beyond);
    assert!(hand.facings().is_empty());
}

#[test]
fn corner_of_three_boxes_holds_the_proxy_in_it() {
    let far = 0.5;
    let walls = [
        block([-far, 0.0, 0.0], [far, 1.0, 1.0], false),
        block([0.0, -far, 0.0], [1.0, far, 1.0], false),
        block([0.0, 0.0, -far], [1.0, 1.0, far], false),
    ];
    let mut hand = Hand::among(&walls);
    hand.to(&V3::new(0.01, 0.02, 0.03));
    assert_near(
        hand.to(&V3::new(-0.01, -0.02, 0.03)),
        V3::new(0.0, 0.0, 0.03),
    );
    assert_near(hand.to(&V3::new(-0.01, -0.02, -0.03)), V3::zeros());
    assert_eq!(hand.facings().len(), 3);
}

#[test]
fn corner_in_a_hollow_box_has_a_facing_for_each_face() {
    let mut hand = Hand::among(&[block([0.0; 3], [0.02, 0.03, 0.04], true)]);
    hand.to(&V3::zeros());
    let p = hand.to(&V3::new(0.05, -0.05, 0.05));
    assert_near(p, V3::new(0.02, -0.03, 0.04));
    let depths = hand
        .facings()
        .iter()
        .map(|f| f.depth_m(&V3::new(0.05, -0.05, 0.05)));
    assert!((depths.sum::<f64>() - (0.03 + 0.02 + 0.01)).abs() < 1e-12);
}

#[test]
fn shell_is_felt_from_the_side_where_the_tip_was() {
    let shells = [
        Shape::Sphere {
            center_m: [0.0; 3],
            radius_m: 0.02,
            hollow: true,
        },
        block([0.0; 3], [0.02; 3], true),
        Shape::Capsule {
            from_m: [0.0; 3],
            to_m: [0.0, 0.01, 0.0],
            radius_m: 0.02,
            hollow: true,
        },
    ];
    for shell in shells {
        let mut hand = Hand::among(&[shell]);
        hand.to(&V3::zeros());
        assert_near(
            hand.settle(&V3::new(0.03, 0.0, 0.0)),
            V3::new(0.02, 0.0, 0.0),
        );
        let mut hand = Hand::among(&[shell]);
        hand.to(&V3::new(0.03, 0.0, 0.0));
        assert_near(
            hand.settle(&V3::new(0.01, 0.0, 0.0)),
            V3::new(0.02, 0.0, 0.0),
        );
    }
}

#[test]
fn thinnest_wall_holds_the_fastest_tip() {
    for half_m in [0.0, 0.00005, 0.0005] {
        for hollow in [false, true] {
            let mut hand = Hand::among(&[block([0.0; 3], [0.1, 0.1, half_m], hollow)]);
            hand.to(&V3::new(0.0, 0.0, 0.01));
            assert_near(
                hand.to(&V3::new(0.0, 0.03, -0.05)),
                V3::new(0.0, 0.03, half_m),
            );
            assert_eq!(hand.facings().len(), 1);
        }
    }
}

#[test]
fn tip_that_is_nowhere_leaves_the_proxy_where_it_was() {
    let mut hand = Hand::among(&[block([0.0; 3], [0.02; 3], false)]);
    let p = hand.to(&V3::new(0.0, 0.0, 0.03));
    for nowhere in [f64::NAN, f64::INFINITY] {
        assert_eq!(hand.to(&V3::new(0.0, nowhere, 0.0)), p);
        assert!(hand.facings().is_empty());
    }
    assert_near(hand.to(&V3::zeros()), V3::new(0.0, 0.0, 0.02));
}
