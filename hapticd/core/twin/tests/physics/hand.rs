//! The operator, with and without a device against it.

use crate::models;
use crate::rig::{brakes, Rig};
use hapticd_control::io::Command;
use hapticd_control::linear::V3;
use hapticd_twin::hand::Hand;
use hapticd_twin::model::HandModel;
use hapticd_twin::{Script, TwinModel};

const H: f64 = 5e-5;

fn arm() -> HandModel {
    match models::hhd().1 {
        TwinModel::Hhd(twin) => twin.hand,
        TwinModel::Phantom(_) => unreachable!("the shipped HHD has an HHD twin"),
    }
}

/// Hand against a tip that nothing moves.
fn against_a_wall(hand: &mut Hand, tip: V3, duration_s: f64) -> V3 {
    (0..(duration_s / H) as usize).fold(V3::zeros(), |_, _| hand.step(&tip, &V3::zeros(), H))
}

#[test]
fn a_push_settles_at_its_force() {
    let tip = V3::new(0.0, 0.2, 0.0);
    let mut hand = Hand::new(&arm(), tip, 2);
    hand.begin(Script::Push {
        direction: [0.0, -2.0, 0.0],
        force_n: 27.0,
        speed_m_per_s: 0.25,
    });
    let force = against_a_wall(&mut hand, tip, 3.0);
    assert!((force - V3::new(0.0, -27.0, 0.0)).norm() < 0.05, "{force}");
}

#[test]
fn a_new_grip_starts_without_a_step() {
    let tip = V3::new(0.0, 0.2, 0.0);
    let mut hand = Hand::new(&arm(), tip, 2);
    hand.begin(Script::Follow {
        target_m: [0.1, 0.25, 0.0],
    });
    assert!(hand.step(&tip, &V3::zeros(), H).norm() < 0.01);
}

#[test]
fn a_script_cannot_leave_the_plane_of_a_two_joint_device() {
    let tip = V3::new(0.0, 0.2, 0.0);
    let mut hand = Hand::new(&arm(), tip, 2);
    hand.begin(Script::Follow {
        target_m: [0.05, 0.2, 0.3],
    });
    assert_eq!(against_a_wall(&mut hand, tip, 0.5).z, 0.0);
    hand.begin(Script::Push {
        direction: [0.0, 0.0, 1.0],
        force_n: 5.0,
        speed_m_per_s: 0.1,
    });
    let force = against_a_wall(&mut hand, tip, 0.5);
    assert!(
        force.x > 10.0,
        "a push without a direction in the plane is ignored: {force}"
    );
}

#[test]
fn the_first_peak_grows_with_the_speed_of_impact() {
    // Two masses against something rigid: about v0 √(k_g m_a), 104 N·s/m with the fitted arm.
    let peak = |speed: f64| {
        let mut hand = Hand::new(&arm(), V3::zeros(), 2);
        hand.begin(Script::Push {
            direction: [1.0, 0.0, 0.0],
            force_n: 1e4,
            speed_m_per_s: speed,
        });
        let flight = V3::new(speed, 0.0, 0.0);
        let mut tip = V3::zeros();
        for _ in 0..(1.0 / H) as usize {
            tip += flight * H;
            hand.step(&tip, &flight, H);
        }
        (0..(0.03 / H) as usize)
            .map(|_| hand.step(&tip, &V3::zeros(), H).x)
            .fold(0.0_f64, f64::max)
    };
    assert!((peak(0.25) - 26.0).abs() < 6.0, "{}", peak(0.25));
    assert!((peak(1.5) / peak(0.25) - 6.0).abs() < 0.3);
}

#[test]
fn a_minimum_jerk_path_ends_where_it_should_and_peaks_in_the_middle() {
    let mut rig = Rig::phantom();
    rig.rest(0.01);
    let from = rig.tip();
    let to = from + V3::new(0.0, 0.05, 0.0);
    rig.twin.hand(Script::MinimumJerk {
        from_m: from.into(),
        to_m: to.into(),
        duration_s: 0.375,
    });
    let mut fastest: f64 = 0.0;
    for _ in 0..2000 {
        rig.rest(0.001);
        fastest = fastest.max(rig.twin.truth().tip_velocity_m_per_s[1]);
    }
    assert!((rig.tip() - to).norm() < 0.001, "{}", rig.tip() - to);
    // Peak of the intention: 1.875 D/T = 0.25 m/s; the arm follows it closely.
    assert!((fastest - 0.25).abs() < 0.04, "{fastest}");
}

#[test]
fn a_stroke_swings_the_tip_at_its_frequency() {
    let mut rig = Rig::phantom();
    rig.rest(0.01);
    let center = rig.tip();
    rig.twin.hand(Script::Stroke {
        center_m: center.into(),
        axis: [0.0, 1.0, 0.0],
        amplitude_m: 0.02,
        frequency_hz: 2.0,
    });
    rig.rest(1.0);
    let side = |rig: &Rig| (rig.tip() - center).y > 0.0;
    let mut crossings = 0;
    for _ in 0..2000 {
        let before = side(&rig);
        rig.rest(0.001);
        crossings += u32::from(side(&rig) != before);
    }
    assert!((7..=9).contains(&crossings), "{crossings}");
}

#[test]
fn a_clamp_carries_the_tip_to_its_point_and_reads_the_motor_force() {
    let mut rig = Rig::phantom();
    rig.rest(0.01);
    let point = rig.tip() + V3::new(0.005, 0.01, -0.005);
    rig.twin.hand(Script::Clamp {
        position_m: point.into(),
    });
    rig.rest(1.0);
    assert!((rig.tip() - point).norm() < 1e-5);
    let command = Command {
        enable: true,
        motor_v: [0.05, 0.1, -0.1],
        ..Command::default()
    };
    rig.run(0.2, &command);
    let truth = rig.twin.truth();
    let jacobian = rig
        .device
        .kinematics
        .jacobian(&V3::from(truth.joint_position_rad));
    let left_over = jacobian.tr_mul(&rig.hand_force()) + V3::from(truth.motor_torque_nm);
    // What remains is at most friction.
    assert!(left_over.abs().max() < 0.0057, "{left_over}");
}

#[test]
fn a_target_out_of_reach_gets_no_more_than_the_arms_strength() {
    let tip = V3::new(0.0, 0.2, 0.0);
    let mut hand = Hand::new(&arm(), tip, 2);
    hand.begin(Script::Follow {
        target_m: [0.0, 9.0, 0.0],
    });
    let force = against_a_wall(&mut hand, tip, 12.0).norm();
    assert!((force - arm().arm_force_max_n).abs() < 0.1, "{force}");
}

#[test]
fn a_braced_arm_yields_less() {
    let yielded = |stiff: bool| {
        let mut rig = Rig::phantom();
        rig.rest(0.01);
        let start = rig.tip();
        rig.twin.hand(Script::Hold { stiff });
        rig.run(
            1.0,
            &Command {
                enable: true,
                motor_v: [0.1, 0.0, 0.0],
                ..Command::default()
            },
        );
        (rig.tip() - start).norm()
    };
    assert!(yielded(true) < 0.7 * yielded(false));
}

#[test]
fn a_hand_that_lets_go_leaves_no_force() {
    let mut rig = Rig::hhd();
    rig.push([0.0, -1.0, 0.0], 20.0);
    rig.run(0.5, &brakes(10.0));
    assert!(rig.hand_force().norm() > 1.0);
    rig.twin.hand(Script::Free);
    rig.rest(0.002);
    assert_eq!(rig.hand_force(), V3::zeros());
}
