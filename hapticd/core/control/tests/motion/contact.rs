use crate::walls::{wall, walls};
use hapticd_control::contact::{contact, Contact};
use hapticd_control::linear::V3;
use proptest::prelude::*;

proptest! {
    #[test]
    fn reported_wall_is_the_deepest(walls in walls(12), x in prop::array::uniform3(-0.1..0.1_f64)) {
        let x = V3::from(x);
        let found = contact(&walls, &x);
        let solid = walls.iter().filter(|wall| wall.eta < 1.0);
        let deepest = solid.map(|wall| wall.depth_m(&x)).fold(0.0, f64::max);
        prop_assert_eq!(found.depth_m, deepest);
        prop_assert_eq!(found.count == 0, found == Contact::FREE);
        if found.count > 0 {
            prop_assert_eq!(found.normal, V3::from(walls[found.wall].normal));
        }
    }
}

#[test]
fn every_solid_wall_touched_is_counted() {
    let up = V3::z();
    let walls = [
        wall(up, 0.01, 0.0),
        wall(up, 0.02, 0.5),
        wall(up, 0.03, 1.0),
        wall(up, -0.01, 0.0),
    ];
    let found = contact(&walls, &V3::zeros());
    assert_eq!((found.count, found.wall, found.depth_m), (2, 1, 0.02));
}

#[test]
fn tip_on_the_surface_is_free() {
    assert_eq!(
        contact(&[wall(V3::z(), 0.0, 0.0)], &V3::zeros()),
        Contact::FREE
    );
}
