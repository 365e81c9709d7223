//! Mass matrices against energy, finite differences and published figures.

use crate::models;
use hapticd_control::linear::{M3, V3};
use hapticd_control::model::{DriveModel, KinematicsModel};
use hapticd_twin::linkage::{Linkage, PhantomLinkage, RhombusLinkage};
use hapticd_twin::mechanics::Mechanics;
use hapticd_twin::model::{FrictionModel, PhantomLinkageModel, StopModel};
use hapticd_twin::stops::Stops;
use hapticd_twin::TwinModel;
use proptest::prelude::*;

const FRICTIONLESS: FrictionModel = FrictionModel {
    coulomb_nm: [0.0; 3],
    viscous_nm_s_per_rad: [0.0; 3],
};

/// Bodies of the PHANTOM Premium 1.5 (Cavusoglu 2001, Table 1).
const PREMIUM_1_5: PhantomLinkageModel = PhantomLinkageModel {
    forearm_kg: 0.0202,
    forearm_kg_m2: [0.4864e-4, 0.001843e-4, 0.4864e-4],
    rod_kg: 0.0249,
    rod_kg_m2: [0.959e-4, 0.959e-4, 0.0051e-4],
    upper_kg: 0.2359,
    upper_kg_m2: [11.09e-4, 10.06e-4, 0.591e-4],
    lower_kg: 0.1906,
    lower_kg_m2: [7.11e-4, 0.629e-4, 6.246e-4],
    base_kg_m2: 11.87e-4,
    short_link_m: 0.0325,
    upper_offset_m: -0.0368,
    lower_offset_m: 0.0527,
    gravity_m_per_s2: 9.81,
};

fn phantom_linkage() -> PhantomLinkage {
    let (device, model) = models::phantom();
    match (device.kinematics, &device.drive, model) {
        (
            KinematicsModel::Phantom { l1_m, l2_m, .. },
            DriveModel::Spring(drive),
            TwinModel::Phantom(twin),
        ) => PhantomLinkage::new(
            &twin.linkage,
            l1_m,
            l2_m,
            &drive.ratio,
            twin.winding.rotor_kg_m2,
        ),
        _ => unreachable!("the shipped PHANTOM is one"),
    }
}

fn rhombus_linkage() -> RhombusLinkage {
    match models::hhd() {
        (device, TwinModel::Hhd(twin)) => match device.kinematics {
            KinematicsModel::Rhombus { l_m, .. } => RhombusLinkage::new(&twin.linkage, l_m),
            KinematicsModel::Phantom { .. } => unreachable!("the shipped HHD is a rhombus"),
        },
        _ => unreachable!("the shipped HHD has an HHD twin"),
    }
}

/// Without friction, far from the stops, in a pose where the linkage swings freely.
fn free<L: Linkage>(linkage: L, kinematics: KinematicsModel, q: V3, qd: V3) -> Mechanics<L> {
    let (device, _) = models::phantom();
    let far = StopModel {
        margin_rad: 1e3,
        stiffness_nm_per_rad: 0.0,
        damping_nm_s_per_rad: 0.0,
    };
    let stops = Stops::new(&far, &device.joints, &kinematics);
    let mut mechanics = Mechanics::new(linkage, kinematics, &FRICTIONLESS, stops, q);
    mechanics.qd = qd;
    mechanics
}

/// Largest change of energy over half a second, relative to the kinetic energy at the start.
fn energy_drift<L: Linkage>(mut mechanics: Mechanics<L>, potential_j: f64, h: f64) -> f64 {
    let start = mechanics.energy_j();
    let kinetic = start - potential_j;
    let mut drift: f64 = 0.0;
    for _ in 0..(0.5 / h) as usize {
        mechanics.advance(&V3::zeros(), &V3::zeros(), h);
        drift = drift.max((mechanics.energy_j() - start).abs() / kinetic);
    }
    drift
}

#[test]
fn a_free_phantom_keeps_its_energy() {
    let q = V3::new(0.3, 0.4, 0.2);
    let swing = |h: f64| {
        let linkage = phantom_linkage();
        let mechanics = free(
            linkage,
            models::phantom().0.kinematics,
            q,
            V3::new(2.0, 1.5, -1.0),
        );
        energy_drift(mechanics, linkage.potential_j(&q), h)
    };
    // First-order integrator: the drift shrinks with the step, so the equations themselves conserve.
    assert!(swing(1e-5) < 1e-3, "{}", swing(1e-5));
    assert!(swing(1e-6) < 0.15 * swing(1e-5));
}

#[test]
fn a_free_rhombus_keeps_its_energy() {
    let q = V3::new(0.5, 2.6, 0.0);
    let swing = |h: f64| {
        let mechanics = free(
            rhombus_linkage(),
            models::hhd().0.kinematics,
            q,
            V3::new(1.0, -1.5, 0.0),
        );
        energy_drift(mechanics, 0.0, h)
    };
    assert!(swing(1e-5) < 1e-3, "{}", swing(1e-5));
    assert!(swing(1e-6) < 0.15 * swing(1e-5));
}

/// C q̇ + G from the mass matrix and the potential alone: Ṁ q̇ − ½ ∂(q̇ᵀMq̇)/∂q + ∂V/∂q.
fn bias_from_energy<L: Linkage>(linkage: &L, q: &V3, qd: &V3) -> V3 {
    const STEP: f64 = 1e-5;
    let mut bias = V3::zeros();
    let mut mass_rate = M3::zeros();
    for i in 0..3 {
        let mut ahead = *q;
        let mut behind = *q;
        ahead[i] += STEP;
        behind[i] -= STEP;
        let mass_by_q = (linkage.mass(&ahead) - linkage.mass(&behind)) / (2.0 * STEP);
        let potential_by_q =
            (linkage.potential_j(&ahead) - linkage.potential_j(&behind)) / (2.0 * STEP);
        mass_rate += mass_by_q * qd[i];
        bias[i] = potential_by_q - 0.5 * qd.dot(&(mass_by_q * qd));
    }
    bias + mass_rate * qd
}

proptest! {
    #[test]
    fn velocity_and_gravity_torques_follow_from_the_energy(
        q in prop::array::uniform3(-1.5_f64..1.5), qd in prop::array::uniform3(-5.0_f64..5.0),
    ) {
        let (q, qd) = (V3::from(q), V3::from(qd));
        let phantom = phantom_linkage();
        prop_assert!((phantom.dynamics(&q, &qd).1 - bias_from_energy(&phantom, &q, &qd)).norm() < 1e-8);
        let rhombus = rhombus_linkage();
        let flat = V3::new(qd[0], qd[1], 0.0);
        prop_assert!((rhombus.dynamics(&q, &flat).1 - bias_from_energy(&rhombus, &q, &flat)).norm() < 1e-7);
    }

    #[test]
    fn mass_matrices_are_positive_definite(q in prop::array::uniform3(-3.0_f64..3.0)) {
        let q = V3::from(q);
        prop_assert!(phantom_linkage().mass(&q).cholesky().is_some());
        prop_assert!(rhombus_linkage().mass(&q).cholesky().is_some());
    }
}

/// Apparent masses along x, y and z, g.
fn apparent_g<L: Linkage>(linkage: L, kinematics: KinematicsModel, q: V3) -> V3 {
    let mobility = free(linkage, kinematics, q, V3::zeros()).tip_mobility();
    mobility.diagonal().map(|inverse_kg| 1e3 / inverse_kg)
}

#[test]
fn apparent_mass_of_the_premium_1_5_is_the_published_one() {
    let linkage = PhantomLinkage::new(&PREMIUM_1_5, 0.215, 0.170, &[13.3, 11.2, 11.2], 1.08e-6);
    let kinematics = KinematicsModel::Phantom {
        l1_m: 0.215,
        l2_m: 0.170,
        coupling_min_rad: -1.0,
        coupling_max_rad: 1.0,
    };
    // Maker's figure: below 75 g; 37, 81 and 55 g from the published bodies at q2 = q3 = 0.
    let apparent = apparent_g(linkage, kinematics, V3::zeros());
    assert!(
        (apparent - V3::new(37.0, 81.0, 55.0)).abs().max() < 1.0,
        "{apparent}"
    );
}

#[test]
fn the_phantom_1_0_weighs_little_and_is_balanced() {
    let linkage = phantom_linkage();
    let apparent = apparent_g(linkage, models::phantom().0.kinematics, V3::zeros());
    assert!(
        apparent.min() > 40.0 && apparent.max() < 150.0,
        "{apparent}"
    );
    for (q2, q3) in [(0.0, 0.0), (0.9, 0.9), (1.5, 0.5)] {
        let gravity = linkage.dynamics(&V3::new(0.0, q2, q3), &V3::zeros()).1;
        // 5 mN at 140 mm: far below the friction.
        assert!(gravity.norm() < 7e-4, "{gravity}");
    }
}

#[test]
fn the_rhombus_is_heavier_across_than_along() {
    let kinematics = models::hhd().0.kinematics;
    let (device, model) = models::hhd();
    let home = V3::from(device.joints.home_rad);
    let TwinModel::Hhd(twin) = model else {
        unreachable!("the shipped HHD has an HHD twin")
    };
    let far = Stops::new(&twin.stops, &device.joints, &kinematics);
    let mechanics = Mechanics::new(rhombus_linkage(), kinematics, &FRICTIONLESS, far, home);
    let apparent = mechanics
        .tip_mobility()
        .fixed_view::<2, 2>(0, 0)
        .try_inverse()
        .expect("regular pose");
    // At (0, 200) mm with a 14:1 gear: 1.2 kg radially (y), 2.8 kg tangentially (x).
    assert!((apparent[(1, 1)] - 1.2).abs() < 0.05, "{apparent}");
    assert!((apparent[(0, 0)] - 2.8).abs() < 0.1, "{apparent}");
}
