use crate::walls::{wall, walls};
use hapticd_control::contact::{contact, Contact};
use hapticd_control::facing::Facing;
use hapticd_control::linear::V3;
use proptest::prelude::*;

/// Each plane of a wall of its own.
fn numbered(mut walls: Vec<Facing>) -> Vec<Facing> {
    (0..)
        .zip(&mut walls)
        .for_each(|(i, facing)| facing.wall = i);
    walls
}

proptest! {
    #[test]
    fn reported_wall_is_the_deepest(walls in walls(12), x in prop::array::uniform3(-0.1..0.1_f64)) {
        let x = V3::from(x);
        let walls = numbered(walls);
        let found = contact(&walls, &x, &x);
        let solid = walls.iter().filter(|wall| wall.eta < 1.0);
        let deepest = solid.map(|wall| wall.depth_m(&x)).fold(0.0, f64::max);
        prop_assert_eq!(found.depth_m, deepest);
        prop_assert_eq!(found.count == 0, found == Contact::free(&x));
        if found.count > 0 {
            prop_assert_eq!(found.normal, V3::from(walls[found.wall].normal));
        }
    }
}

#[test]
fn every_solid_wall_touched_is_counted() {
    let up = V3::z();
    let walls = numbered(vec![
        wall(up, 0.01, 0.0),
        wall(up, 0.02, 0.5),
        wall(up, 0.03, 1.0),
        wall(up, -0.01, 0.0),
    ]);
    let found = contact(&walls, &V3::zeros(), &V3::zeros());
    assert_eq!((found.count, found.wall, found.depth_m), (2, 1, 0.02));
}

#[test]
fn walls_touched_are_named_deepest_first() {
    let depths_m = [0.01, 0.03, 0.0, 0.02, 0.005];
    let facings = numbered(depths_m.map(|depth_m| wall(V3::z(), depth_m, 0.0)).to_vec());
    let proxy = V3::new(0.0, 0.0, 0.03);
    let found = contact(&facings, &V3::zeros(), &proxy);
    assert_eq!((found.count, found.touched), (4, [1, 3, 0]));
    assert_eq!(found.proxy, proxy);
    let two = contact(&facings[..2], &V3::zeros(), &proxy);
    assert_eq!(two.touched, [1, 0, usize::MAX]);
}

#[test]
fn wall_with_several_planes_is_touched_once() {
    let corner = [V3::x(), V3::y(), V3::z()].map(|n| wall(n, 0.01, 0.0));
    let found = contact(&corner, &V3::new(0.0, 0.0, -0.01), &V3::zeros());
    assert_eq!((found.count, found.wall, found.depth_m), (1, 0, 0.02));
    assert_eq!(found.normal, V3::z());
}

#[test]
fn tip_on_the_surface_is_free() {
    assert_eq!(
        contact(&[wall(V3::z(), 0.0, 0.0)], &V3::zeros(), &V3::zeros()),
        Contact::free(&V3::zeros())
    );
}
