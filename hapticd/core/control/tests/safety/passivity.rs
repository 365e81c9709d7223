//! No law with `passivity` gives back more energy than it took, as a plant counts it.

use crate::models::{hhd, phantom};
use crate::plant::{Hand, Path, Plant, Truth};
use crate::rig::{scene, Rig, RATE_HZ};
use hapticd_control::linear::V3;
use hapticd_control::model::{DeviceModel, DriveModel};
use hapticd_control::passivity::Passivity;
use hapticd_control::record::flag;
use hapticd_control::scene::{Allocation, CubicForm, Law, Scene, Wall};
use proptest::prelude::*;
use std::f64::consts::TAU;

const TICKS: usize = 700;

#[derive(Clone, Debug)]
struct Trial {
    spatial: bool,
    spare_ticks: usize,
    law: Law,
    truth: Truth,
    hand: Hand,
    /// Amplitudes along and across the wall's normal, m; frequency, Hz; phase.
    swings: Vec<(f64, f64, f64, f64)>,
    /// Where the tip starts, m above the wall.
    above_m: f64,
}

fn law(spatial: bool) -> impl Strategy<Value = Law> {
    let (stiff, damping) = if spatial {
        (20_000.0, 20.0)
    } else {
        (300_000.0, 1_000.0)
    };
    prop_oneof![
        (0.0..0.9).prop_map(|eta| Law::Motion { eta }),
        (0.01..1.0, 0.0..0.3).prop_map(move |(k, b)| Law::Spring {
            stiffness_n_per_m: k * stiff,
            damping_n_s_per_m: b * damping,
        }),
        (0.05..1.0).prop_map(move |b| Law::Damper {
            damping_n_s_per_m: b * damping
        }),
        (1e5..3e6, any::<bool>()).prop_map(|(coefficient_n_s3_per_m3, implicit)| {
            let form = [CubicForm::Explicit, CubicForm::Implicit][usize::from(implicit)];
            Law::CubicDamper {
                coefficient_n_s3_per_m3,
                form,
            }
        }),
    ]
}

fn hand(spatial: bool) -> impl Strategy<Value = Hand> {
    let scale = if spatial { 0.2 } else { 1.0 };
    let compliant = (
        0.1..1.5,
        500.0..15_000.0,
        2.0..60.0,
        50.0..1_500.0,
        5.0..40.0,
    );
    let compliant =
        compliant.prop_map(
            move |(mass, grip_k, grip_b, arm_k, arm_b)| Hand::Compliant {
                mass_kg: mass * scale,
                grip_n_per_m: grip_k * scale,
                grip_n_s_per_m: grip_b * scale,
                arm_n_per_m: arm_k * scale,
                arm_n_s_per_m: arm_b * scale,
            },
        );
    prop_oneof![3 => compliant, 1 => Just(Hand::Firm)]
}

/// A device that is late by up to what its model spares, lag included.
fn truth(spatial: bool) -> impl Strategy<Value = (usize, Truth)> {
    let force = if spatial { 0.1 } else { 4.0 };
    (
        0_usize..=2,
        any::<bool>(),
        1.0..2.0,
        0.5..1.5,
        0.0..1.0,
        0.0..1.0,
    )
        .prop_map(
            move |(spare, late, mass_scale, lag_scale, friction, damping)| {
                let late = late || spare == 0;
                let truth = Truth {
                    extra_ticks: if late { spare } else { spare - 1 },
                    mass_scale,
                    lag_scale: if late {
                        f64::min(lag_scale, 1.0)
                    } else {
                        lag_scale
                    },
                    friction_n: friction * force,
                    damping_n_s_per_m: damping * force,
                };
                (spare, truth)
            },
        )
}

fn trial() -> impl Strategy<Value = Trial> {
    any::<bool>().prop_flat_map(|spatial| {
        let swing = (0.001..0.02, -0.01..0.01, 0.2..6.0, 0.0..TAU);
        let swings = prop::collection::vec(swing, 1..4);
        (
            law(spatial),
            truth(spatial),
            hand(spatial),
            swings,
            -0.005..0.01,
        )
            .prop_map(
                move |(law, (spare_ticks, truth), hand, swings, above_m)| Trial {
                    spatial,
                    spare_ticks,
                    law,
                    truth,
                    hand,
                    swings,
                    above_m,
                },
            )
    })
}

impl Trial {
    fn model(&self) -> DeviceModel {
        let mut model = if self.spatial { phantom() } else { hhd() };
        model.limits.delay_spare_ticks = self.spare_ticks;
        model
    }

    /// Rig and plant with a wall in front of the tip that faces the base, and the hand's path.
    fn begin(&self, passivity: bool) -> (Rig, Plant) {
        let mut rig = Rig::running(self.model());
        let tip = V3::from(rig.record.tip_position_m);
        let normal = -tip.normalize();
        rig.controller
            .adopt(&motors_only(&self.wall(&rig, passivity), 0.0));
        let across = V3::new(-normal.y, normal.x, 0.0).normalize();
        let swings = self.swings.iter().map(|&(along_m, across_m, hz, phase)| {
            (along_m * normal + across_m * across, TAU * hz, phase)
        });
        let path = Path {
            center_m: tip,
            swings: swings.collect(),
        };
        let plant = Plant::new(&self.model(), self.truth, self.hand.clone(), path);
        (rig, plant)
    }

    fn wall(&self, rig: &Rig, passivity: bool) -> Wall {
        let tip = V3::from(rig.model.kinematics.forward(&rig.home()));
        let normal = -tip.normalize();
        Wall {
            law: self.law,
            passivity,
            ..Wall::plane(1, normal.into(), normal.dot(&tip) - self.above_m, 0.0)
        }
    }

    fn run(&self, passivity: bool, ticks: usize) -> Plant {
        let (mut rig, mut plant) = self.begin(passivity);
        for _ in 0..ticks {
            plant.tick(&mut rig);
        }
        plant
    }

    /// What the promise allows: twice what the encoders hide, as estimate and booking each round
    /// once, and what the hand itself pulls out of the wall before the loop hears of it,
    /// F·a h²/2 with the acceleration a that the hand gives the tip. No wall's is what the spring
    /// drives lend in free space as well: the kinetic energy of their apparent mass, k_T² h/dR.
    fn allowed_j(&self, plant: &Plant) -> f64 {
        let hidden_j = Passivity::new(&self.model(), RATE_HZ.recip()).tolerance_j();
        let pulled_j = plant.pulled_w_per_s * self.late_s().powi(2) / 2.0;
        2.0 * hidden_j + pulled_j + plant.drag_w * self.late_s() / 2.0
    }

    fn keeps_the_promise(&self, plant: &Plant) -> Result<(), TestCaseError> {
        let (least_j, allowed_j) = (plant.least_j, self.allowed_j(plant));
        prop_assert!(least_j >= -allowed_j, "{least_j} J of {allowed_j} J");
        Ok(())
    }

    /// Time from a motion to the end of the force that knew nothing of it.
    fn late_s(&self) -> f64 {
        let model = self.model();
        let lag_s = match &model.drive {
            DriveModel::Torque(drive) => drive.lag_s,
            DriveModel::Spring(drive) => drive.l_h[1] / (drive.r_25_ohm[1] - drive.r_hat_ohm[1]),
        };
        let ticks = 2.0 + self.truth.extra_ticks as f64;
        ticks / RATE_HZ + lag_s * self.truth.lag_scale + model.estimator.lambda_rad_per_s.recip()
    }
}

fn motors_only(wall: &Wall, fade_s: f64) -> Scene {
    Scene {
        allocation: Allocation::MotorOnly,
        ..scene(&[*wall], fade_s)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn no_law_with_passivity_returns_more_energy_than_it_took(trial in trial()) {
        trial.keeps_the_promise(&trial.run(true, TICKS))?;
    }

    #[test]
    fn a_wall_stiffened_under_the_hand_gives_nothing_it_did_not_get(
        trial in trial(),
        stiffer in 1.5..20.0_f64,
    ) {
        let (mut rig, mut plant) = trial.begin(true);
        for tick in 0..TICKS {
            if tick % 150 == 100 {
                let law = Law::Spring {
                    stiffness_n_per_m: 1_000.0 * stiffer.powi((tick / 150) as i32),
                    damping_n_s_per_m: 0.0,
                };
                let wall = Wall { law, ..trial.wall(&rig, true) };
                rig.controller.adopt(&motors_only(&wall, 0.02));
            }
            plant.tick(&mut rig);
        }
        trial.keeps_the_promise(&plant)?;
    }
}

/// A hand on KS's hard spring: what the property must catch.
fn hard_spring(spatial: bool, stiffness_n_per_m: f64) -> Trial {
    let grip = if spatial { 0.2 } else { 1.0 };
    Trial {
        law: Law::Spring {
            stiffness_n_per_m,
            damping_n_s_per_m: 0.0,
        },
        truth: Truth {
            extra_ticks: 1,
            mass_scale: 1.0,
            lag_scale: 1.0,
            friction_n: 0.0,
            damping_n_s_per_m: 0.0,
        },
        hand: Hand::Compliant {
            mass_kg: 1.1 * grip,
            grip_n_per_m: 9_800.0 * grip,
            grip_n_s_per_m: 5.0 * grip,
            arm_n_per_m: 1_050.0 * grip,
            arm_n_s_per_m: 38.0 * grip,
        },
        swings: vec![(0.01, 0.0, 2.0, std::f64::consts::PI)],
        above_m: 0.005,
        spatial,
        spare_ticks: 1,
    }
}

#[test]
fn without_passivity_the_same_walls_return_far_more_than_they_took() {
    let mut led = hard_spring(true, 0.0);
    led.law = Law::Motion { eta: 0.2 };
    led.hand = Hand::Firm;
    led.swings = vec![(0.015, 0.0, 3.0, std::f64::consts::PI)];
    (led.spare_ticks, led.truth.extra_ticks) = (2, 2);
    for trial in [hard_spring(false, 150_000.0), led] {
        let (without, with) = (trial.run(false, 3 * TICKS), trial.run(true, 3 * TICKS));
        let allowed_j = trial.allowed_j(&with);
        assert!(without.least_j < -3.0 * allowed_j, "{} J", without.least_j);
        assert!(with.least_j >= -allowed_j, "{} J", with.least_j);
    }
}

#[test]
fn energies_of_walls_and_device_are_those_that_the_plant_counts() {
    for (spatial, stiffness_n_per_m) in [(false, 30_000.0), (true, 1_000.0)] {
        let mut trial = hard_spring(spatial, stiffness_n_per_m);
        trial.truth.extra_ticks = 0;
        let (mut rig, mut plant) = trial.begin(false);
        let (mut largest_j, mut apart_j): (f64, f64) = (0.0, 0.0);
        let mut free_j = None;
        for _ in 0..400 {
            let taken_j = plant.taken_j;
            plant.tick(&mut rig);
            let device_j = rig.record.device_energy_j;
            largest_j = largest_j.max(taken_j.abs());
            apart_j = apart_j.max((device_j - taken_j).abs());
            if rig.record.contact_count > 0 {
                let wall_j = rig.record.touched_energy_j[0];
                let before_j = *free_j.get_or_insert(device_j - wall_j);
                let away_j = (wall_j - (device_j - before_j)).abs();
                assert!(away_j < 0.03 * largest_j + 1e-4, "{away_j} J");
            } else if free_j.is_some() {
                break;
            }
        }
        assert!(largest_j > 1e-3, "{largest_j} J");
        assert!(apart_j < 0.03 * largest_j, "{apart_j} J of {largest_j} J");
    }
}

#[test]
fn control_is_told_with_its_wall_and_rests_without_contact() {
    let trial = hard_spring(false, 150_000.0);
    let (mut rig, mut plant) = trial.begin(true);
    let mut acted = false;
    for _ in 0..TICKS {
        plant.tick(&mut rig);
        let acts = rig.record.flags & flag::PASSIVITY != 0;
        acted |= acts;
        assert_eq!(acts, rig.record.passivity_wall == 0);
        assert!(!acts || rig.record.contact_count > 0);
        assert!(acts || rig.record.passivity_damping_n_s_per_m == 0.0);
    }
    assert!(acted);
}
