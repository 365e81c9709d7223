//! Random walls of every shape, their distances computed another way, and a hand among them.

use hapticd_control::facing::Facing;
use hapticd_control::linear::V3;
use hapticd_control::proxy::Proxy;
use hapticd_control::scene::{Shape, Wall};
use hapticd_control::supports::Supports;
use proptest::prelude::*;

/// How far a box of a two-joint device reaches along z, m.
const FAR_M: f64 = 10.0;

/// Two-joint devices move in z = 0.
pub fn within(flat: bool, v: V3) -> V3 {
    if flat {
        V3::new(v.x, v.y, 0.0)
    } else {
        v
    }
}

pub fn point(flat: bool, reach_m: f64) -> impl Strategy<Value = V3> {
    prop::array::uniform3(-reach_m..reach_m).prop_map(move |p| within(flat, V3::from(p)))
}

fn direction(flat: bool) -> impl Strategy<Value = V3> {
    point(flat, 1.0)
        .prop_filter("too short for a direction", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

fn frame(flat: bool) -> impl Strategy<Value = [V3; 3]> {
    (direction(flat), direction(false)).prop_filter_map("too close", move |(a, other)| {
        let c = if flat {
            V3::z()
        } else {
            a.cross(&other).try_normalize(0.1)?
        };
        Some([a, c.cross(&a), c])
    })
}

pub fn plane(flat: bool) -> impl Strategy<Value = Shape> {
    (direction(flat), -0.1..-0.01_f64).prop_map(|(n, offset_m)| Shape::Plane {
        normal: n.into(),
        offset_m,
    })
}

pub fn sphere(flat: bool, hollow: bool) -> impl Strategy<Value = Shape> {
    (point(flat, 0.1), 0.002..0.05_f64).prop_map(move |(center, radius_m)| Shape::Sphere {
        center_m: center.into(),
        radius_m,
        hollow,
    })
}

pub fn cuboid(flat: bool, hollow: bool) -> impl Strategy<Value = Shape> {
    let half = prop::array::uniform3(0.00005..0.05_f64);
    (point(flat, 0.1), frame(flat), half).prop_map(move |(center, axes, [a, b, c])| Shape::Box {
        center_m: center.into(),
        axes: axes.map(Into::into),
        half_m: [a, b, if flat { FAR_M } else { c }],
        hollow,
    })
}

pub fn capsule(flat: bool, hollow: bool) -> impl Strategy<Value = Shape> {
    let ends = (point(flat, 0.1), point(flat, 0.1));
    (ends, 0.001..0.04_f64).prop_map(move |((from, to), radius_m)| Shape::Capsule {
        from_m: from.into(),
        to_m: to.into(),
        radius_m,
        hollow,
    })
}

pub fn any_shape(flat: bool, hollow: bool) -> impl Strategy<Value = Shape> {
    prop_oneof![
        sphere(flat, hollow),
        cuboid(flat, hollow),
        capsule(flat, hollow)
    ]
}

/// Distance from the surface, m, negative inside: by the closest point, not by half-spaces.
pub fn distance_m(shape: &Shape, p: &V3) -> f64 {
    match *shape {
        Shape::Plane { normal, offset_m } => V3::from(normal).dot(p) - offset_m,
        Shape::Sphere {
            center_m, radius_m, ..
        } => (p - V3::from(center_m)).norm() - radius_m,
        Shape::Capsule {
            from_m,
            to_m,
            radius_m,
            ..
        } => {
            let (from, to) = (V3::from(from_m), V3::from(to_m));
            let length = (to - from).norm();
            let along = (p - from).dot(&(to - from)) / length;
            (p - from.lerp(&to, (along / length).clamp(0.0, 1.0))).norm() - radius_m
        }
        Shape::Box {
            center_m,
            axes,
            half_m,
            ..
        } => {
            let offset = p - V3::from(center_m);
            let over: [f64; 3] =
                std::array::from_fn(|i| V3::from(axes[i]).dot(&offset).abs() - half_m[i]);
            let outside = V3::from(over.map(|o| o.max(0.0))).norm();
            outside + over.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
        }
    }
}

/// A rigid wall of a shape.
pub fn wall_of(key: u64, shape: Shape) -> Wall {
    Wall {
        shape,
        ..Wall::plane(key, [0.0, 0.0, 1.0], 0.0, 0.0)
    }
}

pub fn walls_of(shapes: &[Shape]) -> Vec<Wall> {
    let number = |(key, shape): (u64, &Shape)| wall_of(key, *shape);
    (1..).zip(shapes).map(number).collect()
}

/// A tip and its proxy among walls.
pub struct Hand {
    pub walls: Vec<Wall>,
    proxy: Box<Proxy>,
    around: Box<Supports>,
}

impl Hand {
    pub fn among(shapes: &[Shape]) -> Self {
        let mut hand = Self {
            walls: Vec::new(),
            proxy: Box::default(),
            around: Box::default(),
        };
        hand.edit(walls_of(shapes));
        hand
    }

    /// Replaces the walls.
    pub fn edit(&mut self, walls: Vec<Wall>) {
        let history = self.proxy.history().carried(&self.walls, &walls);
        self.proxy.adopt(&walls, history);
        self.walls = walls;
    }

    /// Moves the tip; where the proxy comes to rest, m.
    pub fn to(&mut self, x: &V3) -> V3 {
        self.proxy.follow(&self.walls, x, &mut self.around);
        self.proxy.point()
    }

    /// Moves the tip and lets the proxy come to rest.
    pub fn settle(&mut self, x: &V3) -> V3 {
        (0..20).for_each(|_| {
            self.to(x);
        });
        self.to(x)
    }

    pub fn facings(&self) -> &[Facing] {
        self.proxy.facings().as_slice()
    }

    /// Whether the proxy is in none of the walls that were solid from the start.
    pub fn distances_m(&self) -> Vec<f64> {
        let p = self.proxy.point();
        self.walls
            .iter()
            .map(|wall| distance_m(&wall.shape, &p))
            .collect()
    }
}
