//! Walls as words, and whether their numbers make sense.

use crate::codec::{Decoder, Encoder};
use hapticd_control::io::{Axes, AXES};
use hapticd_control::scene::{CubicForm, Friction, FrictionActuator, Law, Shape, Wall};

/// Numbers of the longest shape.
const SHAPE_NUMBERS: usize = 15;
/// Numbers of the longest law.
const LAW_NUMBERS: usize = 2;

/// Words of one wall: key, switches, shape, law, friction.
pub const WALL_WORDS: usize = 2 + (2 + SHAPE_NUMBERS) + (1 + LAW_NUMBERS) + 3;

/// How far a unit vector may be from unit length, and two edges from a right angle.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Whether every number makes sense. Written so that a NaN fails.
#[must_use]
pub fn is_valid(wall: &Wall) -> bool {
    let Friction {
        static_, kinetic, ..
    } = wall.friction;
    shape_is_valid(&wall.shape) && law_is_valid(&wall.law) && is_size(kinetic) && {
        is_size(static_) && static_ >= kinetic
    }
}

fn shape_is_valid(shape: &Shape) -> bool {
    match shape {
        Shape::Plane { normal, offset_m } => is_unit(normal) && offset_m.is_finite(),
        Shape::Sphere {
            center_m, radius_m, ..
        } => is_finite(center_m) && is_size(*radius_m),
        Shape::Box {
            center_m,
            axes,
            half_m,
            ..
        } => is_finite(center_m) && is_frame(axes) && half_m.iter().all(|half| is_size(*half)),
        Shape::Capsule {
            from_m,
            to_m,
            radius_m,
            ..
        } => is_finite(from_m) && is_finite(to_m) && is_size(*radius_m),
    }
}

fn law_is_valid(law: &Law) -> bool {
    match *law {
        Law::Motion { eta } => (0.0..=1.0).contains(&eta),
        Law::Spring {
            stiffness_n_per_m,
            damping_n_s_per_m,
        } => is_size(stiffness_n_per_m) && is_size(damping_n_s_per_m),
        Law::Damper { damping_n_s_per_m } => is_size(damping_n_s_per_m),
        Law::CubicDamper {
            coefficient_n_s3_per_m3,
            ..
        } => is_size(coefficient_n_s3_per_m3),
    }
}

/// Whether a number is finite and not negative.
pub(crate) fn is_size(value: f64) -> bool {
    value.is_finite() && value >= 0.0
}

fn is_finite(point: &Axes) -> bool {
    point.iter().all(|value| value.is_finite())
}

fn dot(a: &Axes, b: &Axes) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Whether a vector is of unit length.
pub(crate) fn is_unit(vector: &Axes) -> bool {
    (dot(vector, vector).sqrt() - 1.0).abs() <= UNIT_TOLERANCE
}

fn is_frame(axes: &[Axes; AXES]) -> bool {
    let right = |a: &Axes, b: &Axes| dot(a, b).abs() <= UNIT_TOLERANCE;
    let [a, b, c] = axes;
    axes.iter().all(is_unit) && right(a, b) && right(b, c) && right(c, a)
}

/// Writes a wall.
pub fn encode(wall: &Wall, encoder: &mut Encoder<'_>) {
    let switches = u64::from(wall.passivity) | u64::from(wall.brake) << 1;
    let (shape, hollow, numbers) = shape_numbers(&wall.shape);
    let (law, answer) = law_numbers(&wall.law);
    encoder
        .words(&[wall.key, switches, shape, u64::from(hollow)])
        .numbers(&numbers)
        .word(law)
        .numbers(&answer)
        .number(wall.friction.static_)
        .number(wall.friction.kinetic)
        .word(wall.friction.actuator as u64);
}

/// Reads a wall; `None` where the words hold none.
pub fn decode(decoder: &mut Decoder<'_>) -> Option<Wall> {
    let (key, switches) = (decoder.word()?, decoder.word()?);
    Some(Wall {
        key,
        shape: decode_shape(decoder)?,
        law: decode_law(decoder)?,
        passivity: switches & 1 != 0,
        brake: switches & 2 != 0,
        friction: decode_friction(decoder)?,
    })
}

fn shape_numbers(shape: &Shape) -> (u64, bool, [f64; SHAPE_NUMBERS]) {
    let mut numbers = [0.0; SHAPE_NUMBERS];
    let mut put = |parts: &[&[f64]]| {
        let values = parts.iter().copied().flatten();
        numbers
            .iter_mut()
            .zip(values)
            .for_each(|(slot, value)| *slot = *value);
    };
    let (kind, hollow) = match shape {
        Shape::Plane { normal, offset_m } => {
            put(&[normal, &[*offset_m]]);
            (0, false)
        }
        Shape::Sphere {
            center_m,
            radius_m,
            hollow,
        } => {
            put(&[center_m, &[*radius_m]]);
            (1, *hollow)
        }
        Shape::Box {
            center_m,
            axes,
            half_m,
            hollow,
        } => {
            put(&[center_m, &axes[0], &axes[1], &axes[2], half_m]);
            (2, *hollow)
        }
        Shape::Capsule {
            from_m,
            to_m,
            radius_m,
            hollow,
        } => {
            put(&[from_m, to_m, &[*radius_m]]);
            (3, *hollow)
        }
    };
    (kind, hollow, numbers)
}

fn decode_shape(decoder: &mut Decoder<'_>) -> Option<Shape> {
    let (kind, hollow) = (decoder.word()?, decoder.word()? != 0);
    let numbers = decoder.array::<SHAPE_NUMBERS>()?.map(f64::from_bits);
    let axes = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
    Some(match kind {
        0 => Shape::Plane {
            normal: axes(0),
            offset_m: numbers[3],
        },
        1 => Shape::Sphere {
            center_m: axes(0),
            radius_m: numbers[3],
            hollow,
        },
        2 => Shape::Box {
            center_m: axes(0),
            axes: [axes(3), axes(6), axes(9)],
            half_m: axes(12),
            hollow,
        },
        3 => Shape::Capsule {
            from_m: axes(0),
            to_m: axes(3),
            radius_m: numbers[6],
            hollow,
        },
        _ => return None,
    })
}

fn law_numbers(law: &Law) -> (u64, [f64; LAW_NUMBERS]) {
    match *law {
        Law::Motion { eta } => (0, [eta, 0.0]),
        Law::Spring {
            stiffness_n_per_m,
            damping_n_s_per_m,
        } => (1, [stiffness_n_per_m, damping_n_s_per_m]),
        Law::Damper { damping_n_s_per_m } => (2, [damping_n_s_per_m, 0.0]),
        Law::CubicDamper {
            coefficient_n_s3_per_m3,
            form,
        } => (3 + form as u64, [coefficient_n_s3_per_m3, 0.0]),
    }
}

fn decode_law(decoder: &mut Decoder<'_>) -> Option<Law> {
    let kind = decoder.word()?;
    let [first, second] = decoder.array::<LAW_NUMBERS>()?.map(f64::from_bits);
    let cubic = |form| Law::CubicDamper {
        coefficient_n_s3_per_m3: first,
        form,
    };
    Some(match kind {
        0 => Law::Motion { eta: first },
        1 => Law::Spring {
            stiffness_n_per_m: first,
            damping_n_s_per_m: second,
        },
        2 => Law::Damper {
            damping_n_s_per_m: first,
        },
        3 => cubic(CubicForm::Implicit),
        4 => cubic(CubicForm::Explicit),
        _ => return None,
    })
}

fn decode_friction(decoder: &mut Decoder<'_>) -> Option<Friction> {
    let (static_, kinetic) = (decoder.number()?, decoder.number()?);
    let word = decoder.word()?;
    let actuator = [
        FrictionActuator::Auto,
        FrictionActuator::Motor,
        FrictionActuator::Brake,
    ]
    .into_iter()
    .find(|actuator| *actuator as u64 == word)?;
    Some(Friction {
        static_,
        kinetic,
        actuator,
    })
}
