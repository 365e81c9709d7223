//! Dry friction of coupled joints, stick included.

use hapticd_control::linear::{M3, V3};

/// Most sweeps over the joints in one step; three joints with weak coupling settle in two or three.
const SWEEPS: usize = 4;

/// Change of an impulse, as a share of its limit, below which a sweep has settled.
const SETTLED: f64 = 1e-9;

/// Velocities after the dry-friction impulses of one step, by projected Gauss–Seidel.
///
/// Each impulse stops its joint if it can and is at most its limit: an implicit Coulomb law, so
/// that stick needs no dead zone, does not chatter and never injects energy.
///
/// * `free`: velocities without dry friction, rad/s
/// * `mobility`: M⁻¹, 1/(kg·m²)
/// * `limit`: Coulomb torque times step, N·m·s
/// * `impulse`: impulses of the last step as a start, of this step on return, N·m·s
pub fn rub(free: &V3, mobility: &M3, limit: &V3, impulse: &mut V3) -> V3 {
    for i in 0..3 {
        impulse[i] = impulse[i].clamp(-limit[i], limit[i]);
    }
    let mut velocity = free + mobility * *impulse;
    let inertia = mobility.diagonal().map(f64::recip);
    for _ in 0..SWEEPS {
        let mut settled = true;
        for i in 0..3 {
            let wanted = (impulse[i] - velocity[i] * inertia[i]).clamp(-limit[i], limit[i]);
            let change = wanted - impulse[i];
            impulse[i] = wanted;
            velocity += mobility.column(i) * change;
            settled &= change.abs() <= SETTLED * limit[i];
        }
        if settled {
            break;
        }
    }
    velocity
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn mobility(a: f64, b: f64, c: f64, coupling: f64) -> M3 {
        let m23 = coupling * (b * c).sqrt();
        M3::new(a, 0.0, 0.0, 0.0, b, m23, 0.0, m23, c)
            .try_inverse()
            .unwrap()
    }

    proptest! {
        #[test]
        fn friction_never_adds_kinetic_energy(
            m in [0.1_f64..3.0, 0.1_f64..3.0, 0.1_f64..3.0], coupling in -0.7_f64..0.7,
            free in [-2.0_f64..2.0, -2.0_f64..2.0, -2.0_f64..2.0],
            limit in [0.0_f64..1.0, 0.0_f64..1.0, 0.0_f64..1.0],
        ) {
            let mobility = mobility(m[0], m[1], m[2], coupling);
            let mass = mobility.try_inverse().unwrap();
            let free = V3::from(free);
            let mut impulse = V3::zeros();
            let after = rub(&free, &mobility, &V3::from(limit), &mut impulse);
            let energy = |v: &V3| 0.5 * v.dot(&(mass * v));
            prop_assert!(energy(&after) <= energy(&free) + 1e-12);
        }

        #[test]
        fn friction_opposes_every_joint_that_still_moves(
            free in [-2.0_f64..2.0, -2.0_f64..2.0, -2.0_f64..2.0],
            limit in [0.01_f64..1.0, 0.01_f64..1.0, 0.01_f64..1.0], coupling in -0.5_f64..0.5,
        ) {
            let mut impulse = V3::zeros();
            let mobility = mobility(1.0, 1.0, 1.0, coupling);
            let limit = V3::from(limit);
            let mut after = V3::zeros();
            for _ in 0..20 {
                after = rub(&V3::from(free), &mobility, &limit, &mut impulse);
            }
            for i in 0..3 {
                if after[i].abs() > 1e-6 {
                    prop_assert!((impulse[i] + limit[i] * after[i].signum()).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_joint_below_its_limit_stands_still() {
        let mut impulse = V3::zeros();
        let free = V3::new(0.1, -0.1, 0.05);
        let after = rub(&free, &M3::identity(), &V3::repeat(0.2), &mut impulse);
        assert!(after.norm() < 1e-15);
    }
}
