//! Walls keep the tip on its side through edits.

use crate::solids::*;
use hapticd_control::linear::V3;
use hapticd_control::scene::{Shape, Wall};
use nalgebra::{Rotation3, Unit};
use proptest::prelude::*;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn slab(top_m: f64, thickness_m: f64) -> Shape {
    Shape::Box {
        center_m: [0.0, 0.0, top_m - 0.5 * thickness_m],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], UP],
        half_m: [0.05, 0.05, 0.5 * thickness_m],
        hollow: false,
    }
}

/// Every shape with its top at `top_m`.
fn tops(top_m: f64) -> Vec<Shape> {
    let below = [0.0, 0.0, top_m - 0.02];
    let shapes = |hollow| {
        [
            Shape::Sphere {
                center_m: below,
                radius_m: 0.02,
                hollow,
            },
            Shape::Capsule {
                from_m: below,
                to_m: [0.0, 0.03, top_m - 0.02],
                radius_m: 0.02,
                hollow,
            },
        ]
    };
    let plane = Shape::Plane {
        normal: UP,
        offset_m: top_m,
    };
    let mut all = vec![
        plane,
        slab(top_m, 0.02),
        slab(top_m, 0.001),
        slab(top_m, 0.0),
    ];
    all.extend(shapes(false).into_iter().chain(shapes(true)));
    all
}

/// A hand above the origin that is pushed 1 mm into a wall with its top there.
fn pressing(shape: Shape) -> Hand {
    let mut hand = Hand::among(&[shape]);
    hand.to(&V3::new(0.0, 0.0, 0.01));
    hand.settle(&PRESSED);
    hand
}

const PRESSED: V3 = V3::new(0.0, 0.0, -0.001);

#[test]
fn wall_moved_over_the_tip_still_pushes_it_back_the_same_way() {
    for (before, after) in tops(0.0).into_iter().zip(tops(0.002)) {
        let mut hand = pressing(before);
        hand.edit(walls_of(&[after]));
        let p = hand.settle(&PRESSED);
        assert!(
            (p - V3::new(0.0, 0.0, 0.002)).norm() < 1e-8,
            "{after:?}: {p}"
        );
        let [facing] = hand.facings() else {
            panic!("{after:?} was lost");
        };
        assert!((V3::from(facing.normal) - V3::z()).norm() < 1e-6);
        assert!((facing.depth_m(&PRESSED) - 0.003).abs() < 1e-8);
    }
}

#[test]
fn wall_moved_away_lets_the_tip_go() {
    for (before, after) in tops(0.0).into_iter().zip(tops(-0.002)) {
        let mut hand = pressing(before);
        hand.edit(walls_of(&[after]));
        assert_eq!(hand.settle(&PRESSED), PRESSED);
    }
}

#[test]
fn ball_that_grows_pushes_the_tip_out_along_its_radius() {
    let ball = |radius_m| Shape::Sphere {
        center_m: [0.0; 3],
        radius_m,
        hollow: false,
    };
    let mut hand = Hand::among(&[ball(0.01)]);
    let x = V3::new(0.0, 0.006, 0.009);
    hand.to(&V3::new(0.0, 0.02, 0.03));
    assert_eq!(hand.settle(&x), x);
    hand.edit(walls_of(&[ball(0.03)]));
    assert!((hand.settle(&x) - 0.03 * x.normalize()).norm() < 1e-8);
}

#[test]
fn shell_that_shrinks_past_the_tip_keeps_it_inside() {
    let ball = |radius_m| Shape::Sphere {
        center_m: [0.0; 3],
        radius_m,
        hollow: true,
    };
    let mut hand = Hand::among(&[ball(0.03)]);
    let x = V3::new(0.0, 0.0, 0.02);
    hand.to(&x);
    hand.edit(walls_of(&[ball(0.01)]));
    assert!((hand.settle(&x) - V3::new(0.0, 0.0, 0.01)).norm() < 1e-8);
    assert_eq!(hand.facings()[0].normal, [-0.0, -0.0, -1.0]);
}

#[test]
fn solid_that_appears_around_the_tip_pushes_to_its_nearest_face() {
    let x = V3::new(0.0, 0.0, -0.003);
    let mut hand = Hand::among(&[]);
    hand.to(&x);
    hand.edit(walls_of(&[slab(0.0, 0.02)]));
    assert!((hand.to(&x) - V3::zeros()).norm() < 1e-8);
}

#[test]
fn wall_that_lets_everything_pass_has_no_side_to_remember() {
    let x = V3::new(0.0, 0.0, -0.015);
    let mut walls = walls_of(&[slab(0.0, 0.02)]);
    walls[0].law = hapticd_control::scene::Law::Motion { eta: 1.0 };
    let mut hand = Hand::among(&[]);
    hand.edit(walls);
    hand.to(&V3::new(0.0, 0.0, 0.01));
    assert_eq!(hand.to(&x), x);
    hand.edit(walls_of(&[slab(0.0, 0.02)]));
    assert!((hand.to(&x) - V3::new(0.0, 0.0, -0.02)).norm() < 1e-8);
}

#[test]
fn history_goes_by_key_and_not_by_place() {
    let shell = Shape::Sphere {
        center_m: [0.0; 3],
        radius_m: 0.02,
        hollow: true,
    };
    let far = Shape::Sphere {
        center_m: [0.3, 0.0, 0.0],
        radius_m: 0.01,
        hollow: true,
    };
    let (inside, out) = (V3::zeros(), V3::new(0.0, 0.0, 0.03));
    let mut hand = Hand::among(&[far, shell]);
    hand.to(&inside);
    hand.settle(&out);
    let [first, second] = [hand.walls[0], hand.walls[1]];
    let third = wall_of(9, slab(-0.5, 0.01));
    for walls in [
        vec![second, first],
        vec![third, first, second],
        vec![second],
    ] {
        hand.edit(walls);
        assert!((hand.settle(&out) - V3::new(0.0, 0.0, 0.02)).norm() < 1e-8);
    }
    hand.edit(vec![Wall { key: 77, ..second }]);
    hand.edit(vec![]);
    assert_eq!(hand.to(&out), out);
}

#[test]
fn wall_that_passes_by_does_not_take_the_tip_along() {
    let ball = |x| Shape::Sphere {
        center_m: [x, 0.0, 0.0],
        radius_m: 0.01,
        hollow: false,
    };
    let mut hand = Hand::among(&[ball(-0.1)]);
    let x = V3::new(0.0, 0.02, 0.0);
    hand.to(&x);
    hand.edit(walls_of(&[ball(0.1)]));
    assert_eq!(hand.to(&x), x);
}

fn plate(pose: &Rotation3<f64>, center: &V3, half_m: f64) -> Shape {
    Shape::Box {
        center_m: (*center).into(),
        axes: [V3::x(), V3::y(), V3::z()].map(|axis| (pose * axis).into()),
        half_m: [0.1, 0.1, half_m],
        hollow: false,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn plate_moved_and_turned_never_passes_the_tip(
        moves in prop::collection::vec((point(false, 0.02), point(false, 1.0), 0.0..0.3_f64), 1..4),
        half_m in 0.0..0.001_f64, depth_m in 0.0..0.02_f64,
    ) {
        let x = V3::new(0.0, 0.0, half_m - depth_m);
        let mut hand = Hand::among(&[plate(&Rotation3::identity(), &V3::zeros(), half_m)]);
        hand.to(&V3::new(0.0, 0.0, 0.05));
        hand.settle(&x);
        for (center, axis, angle) in moves {
            prop_assume!(axis.norm() > 0.1);
            let pose = Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle);
            hand.edit(walls_of(&[plate(&pose, &center, half_m)]));
            let p = hand.settle(&x);
            let height_m = (pose * V3::z()).dot(&(p - center));
            prop_assert!(height_m > half_m, "{height_m} above the plate");
        }
    }

    #[test]
    fn proxy_is_in_no_wall_after_any_edit(
        before in prop::collection::vec(any_shape(false, false), 1..6),
        after in prop::collection::vec(any_shape(false, false), 1..3),
        x in point(false, 0.12),
    ) {
        let mut hand = Hand::among(&before);
        hand.to(&V3::new(0.4, 0.3, 0.0));
        hand.settle(&x);
        hand.edit(walls_of(&after));
        let p = hand.settle(&x);
        let squeezed = after.iter().filter(|shape| distance_m(shape, &x) < 0.0).count() > 1;
        let free = hand.distances_m().into_iter().all(|distance_m| distance_m > 0.0);
        prop_assert!(free || squeezed, "{p}");
    }
}
