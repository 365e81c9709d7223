//! A wall that is moved by an edit pushes the proxy along, as if it had come all the way.
//!
//! Each wall does so by itself: what stands behind the proxy does not hold it, so that a wall can
//! push it through another one. Where both are solid and thick the next tick finds it in the other
//! wall, and pushes it out by the nearest face; it crosses one that is thinner than the push.

use crate::linear::{M3, V3};
use crate::scene::Shape;
use crate::shape::cuboid::Cuboid;
use crate::shape::{Ball, Solid, Support};
use crate::supports::CLEARANCE_M;
use nalgebra::{Rotation3, UnitQuaternion};

/// Parts of the way. In each the wall's nearest half-space goes with it and pushes: no wall is
/// too thin, and one that passes by farther away than a part is long does not push.
const PARTS: usize = 16;

/// Where the proxy at `p`, m, outside `before` is pushed when that becomes `after`, m. A shape
/// that becomes another kind appears anew.
#[must_use]
pub fn sweep(before: &Shape, after: &Shape, p: &V3) -> V3 {
    let (first, last) = (Solid::from(before), Solid::from(after));
    if passes_by(&first.ball(), &last.ball(), p) {
        return *p;
    }
    let mut point = *p;
    let mut here = first;
    for part in 1..=PARTS {
        let Some(there) = between(&first, &last, part as f64 / PARTS as f64) else {
            return *p;
        };
        let support = carried(&here, &there, &here.support(&point));
        let behind_m = CLEARANCE_M - support.gap_m(&point);
        if behind_m > 0.0 {
            point += behind_m * support.normal;
        }
        here = there;
    }
    point
}

/// Whether a ball on its way from one to another never comes to `p`.
fn passes_by(from: &Ball, to: &Ball, p: &V3) -> bool {
    let way = to.center_m - from.center_m;
    let share = (p - from.center_m).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
    let closest = from.center_m + share.clamp(0.0, 1.0) * way;
    (p - closest).norm() > from.radius_m.max(to.radius_m)
}

/// The half-space that was `support` of `before`, gone along with the wall.
fn carried(before: &Solid, after: &Solid, support: &Support) -> Support {
    let normal = match (before, after) {
        (Solid::Box(before), Solid::Box(after)) => {
            let local = before.axes.map(|axis| axis.dot(&support.normal));
            after.to_base(&local.into())
        }
        (_, Solid::Plane(plane)) => plane.normal,
        _ => support.normal,
    };
    after.support_along(&normal)
}

/// A solid on its way; `None` between different kinds.
fn between(from: &Solid, to: &Solid, share: f64) -> Option<Solid> {
    let mut solid = *to;
    match (from, &mut solid) {
        (Solid::Plane(_), Solid::Plane(_)) => {}
        (Solid::Sphere(from), Solid::Sphere(to)) => {
            to.center_m = from.center_m.lerp(&to.center_m, share);
            to.radius_m = mix(from.radius_m, to.radius_m, share);
        }
        (Solid::Capsule(from), Solid::Capsule(to)) => {
            to.from_m = from.from_m.lerp(&to.from_m, share);
            to.to_m = from.to_m.lerp(&to.to_m, share);
            to.radius_m = mix(from.radius_m, to.radius_m, share);
        }
        (Solid::Box(from), Solid::Box(to)) => {
            to.center_m = from.center_m.lerp(&to.center_m, share);
            to.half_m = from.half_m.lerp(&to.half_m, share);
            if share < 1.0 {
                to.axes = turned(from, to, share);
            }
        }
        _ => return None,
    }
    Some(solid)
}

/// The axes on the shortest way from one orientation to another.
fn turned(from: &Cuboid, to: &Cuboid, share: f64) -> [V3; 3] {
    let turn = M3::from_columns(&to.axes) * M3::from_columns(&from.axes).transpose();
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    let part = turn.powf(share);
    from.axes.map(|axis| part * axis)
}

fn mix(from: f64, to: f64, share: f64) -> f64 {
    from + share * (to - from)
}
