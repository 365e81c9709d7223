//! What walls are made of, as the proxy sees it: half-spaces that leave the wall out.

pub mod capsule;
pub mod cuboid;
pub mod plane;
pub mod sphere;

use crate::linear::V3;
use crate::scene::Shape;
use capsule::Capsule;
use cuboid::Cuboid;
use plane::Plane;
use sphere::Sphere;

/// A half-space n·y ≥ `offset_m`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Support {
    /// Unit normal into the half-space.
    pub normal: V3,
    /// n·p of a point p of its plane, m.
    pub offset_m: f64,
}

impl Support {
    /// How far `p` is within the half-space, m; negative behind its plane.
    #[must_use]
    pub fn gap_m(&self, p: &V3) -> f64 {
        self.normal.dot(p) - self.offset_m
    }
}

/// The side of a wall on which the tip is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// In front of a plane, around a solid or a shell.
    #[default]
    Outside,
    /// Within a shell.
    Inside,
}

/// A ball that contains a shape; of infinite radius around a plane.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Its centre, m.
    pub center_m: V3,
    /// Its radius, m.
    pub radius_m: f64,
}

/// One of the shapes, ready for computation.
#[derive(Clone, Copy, Debug)]
pub enum Solid {
    /// A half-space.
    Plane(Plane),
    /// A ball.
    Sphere(Sphere),
    /// A cuboid.
    Box(Cuboid),
    /// Everything within a radius of a segment.
    Capsule(Capsule),
}

impl Default for Solid {
    /// A half-space that ends at the origin.
    fn default() -> Self {
        Self::Plane(Plane {
            normal: V3::x(),
            offset_m: 0.0,
        })
    }
}

impl From<&Shape> for Solid {
    fn from(shape: &Shape) -> Self {
        match *shape {
            Shape::Plane { normal, offset_m } => Self::Plane(Plane {
                normal: normal.into(),
                offset_m,
            }),
            Shape::Sphere {
                center_m, radius_m, ..
            } => Self::Sphere(Sphere {
                center_m: center_m.into(),
                radius_m,
            }),
            Shape::Box {
                center_m,
                axes,
                half_m,
                ..
            } => Self::Box(Cuboid {
                center_m: center_m.into(),
                axes: axes.map(V3::from),
                half_m: half_m.into(),
            }),
            Shape::Capsule {
                from_m,
                to_m,
                radius_m,
                ..
            } => Self::Capsule(Capsule {
                from_m: from_m.into(),
                to_m: to_m.into(),
                radius_m,
            }),
        }
    }
}

impl Solid {
    /// The half-space outside the solid that touches it where it is closest to `p`, m. Where `p`
    /// is within the solid, the half-space beyond the nearest face.
    #[must_use]
    pub fn support(&self, p: &V3) -> Support {
        let normal = match self {
            Self::Plane(plane) => plane.normal,
            Self::Sphere(sphere) => sphere.outward(p),
            Self::Box(cuboid) => cuboid.outward(p),
            Self::Capsule(capsule) => capsule.outward(p),
        };
        self.support_along(&normal)
    }

    /// The half-space outside the solid with the inward unit normal `normal`.
    #[must_use]
    pub fn support_along(&self, normal: &V3) -> Support {
        Support {
            normal: *normal,
            offset_m: match self {
                Self::Plane(plane) => plane.offset_m,
                Self::Sphere(sphere) => sphere.extent_m(normal),
                Self::Box(cuboid) => cuboid.extent_m(normal),
                Self::Capsule(capsule) => capsule.extent_m(normal),
            },
        }
    }

    /// Half-spaces around the cavity of the solid's shell: all six of a box, else the one at the
    /// surface above `p`, m. A plane has no cavity.
    pub fn enclose(&self, p: &V3, mut each: impl FnMut(Support)) {
        match self {
            Self::Plane(_) => {}
            Self::Sphere(sphere) => each(self.opposite(&sphere.outward(p))),
            Self::Capsule(capsule) => each(self.opposite(&capsule.outward(p))),
            Self::Box(cuboid) => {
                for axis in cuboid.axes {
                    each(self.opposite(&axis));
                    each(self.opposite(&-axis));
                }
            }
        }
    }

    /// The half-space that contains the solid and ends where it ends along `outward`.
    fn opposite(&self, outward: &V3) -> Support {
        Support {
            normal: -outward,
            offset_m: -self.support_along(outward).offset_m,
        }
    }

    /// Whether a cavity of this shape is bent, so that no finite number of planes encloses it.
    #[must_use]
    pub fn is_round(&self) -> bool {
        matches!(self, Self::Sphere(_) | Self::Capsule(_))
    }

    /// Whether `p`, m, is farther than `reach_m` from the solid, where that is cheap to tell.
    #[must_use]
    pub fn is_beyond(&self, p: &V3, reach_m: f64) -> bool {
        match self {
            Self::Sphere(sphere) => sphere.is_beyond(p, reach_m),
            Self::Box(cuboid) => cuboid.is_beyond(p, reach_m),
            Self::Plane(_) | Self::Capsule(_) => false,
        }
    }

    /// Distance of `p`, m, from the surface; negative inside.
    #[must_use]
    pub fn distance_m(&self, p: &V3) -> f64 {
        self.support(p).gap_m(p)
    }

    /// A ball around it.
    #[must_use]
    pub fn ball(&self) -> Ball {
        match self {
            Self::Plane(_) => Ball {
                center_m: V3::zeros(),
                radius_m: f64::INFINITY,
            },
            Self::Sphere(sphere) => Ball {
                center_m: sphere.center_m,
                radius_m: sphere.radius_m,
            },
            Self::Box(cuboid) => Ball {
                center_m: cuboid.center_m,
                radius_m: cuboid.half_m.norm(),
            },
            Self::Capsule(capsule) => capsule.ball(),
        }
    }
}

/// Whether a wall of this shape is a shell.
#[must_use]
pub fn is_hollow(shape: &Shape) -> bool {
    match *shape {
        Shape::Plane { .. } => false,
        Shape::Sphere { hollow, .. }
        | Shape::Box { hollow, .. }
        | Shape::Capsule { hollow, .. } => hollow,
    }
}
