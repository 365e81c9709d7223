//! Random walls around the origin.

use hapticd_control::facing::Facing;
use hapticd_control::linear::V3;
use proptest::prelude::*;

pub fn wall(normal: V3, offset_m: f64, eta: f64) -> Facing {
    Facing {
        wall: 0,
        normal: normal.into(),
        offset_m,
        eta,
    }
}

pub fn unit() -> impl Strategy<Value = V3> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(V3::from)
        .prop_filter("too short for a direction", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

/// Rigid, free, and everything between.
pub fn eta() -> impl Strategy<Value = f64> {
    prop_oneof![2 => Just(0.0), 1 => Just(1.0), 5 => 0.0..1.0_f64]
}

pub fn any_wall() -> impl Strategy<Value = Facing> {
    (unit(), -0.05..0.05_f64, eta()).prop_map(|(n, offset_m, eta)| wall(n, offset_m, eta))
}

/// Up to `most` walls, where needed with exact duplicates among them.
pub fn walls(most: usize) -> impl Strategy<Value = Vec<Facing>> {
    (prop::collection::vec(any_wall(), 1..=most), 0..=2_usize).prop_map(|(walls, copies)| {
        let mut all = walls.clone();
        all.extend(walls.iter().take(copies).copied());
        all
    })
}
