//! Winding temperature, residual resistance and what they do to the stiffness.

use crate::models::{phantom, spring_drive};
use crate::rig::Rig;
use hapticd_control::fault::Fault;
use hapticd_control::linear::V3;
use hapticd_control::model::{DeviceModel, DriveModel};
use hapticd_control::render::never_stiffer;
use hapticd_control::thermal::{residual_ohm, resistance_ohm, tuned_residual_ohm, Thermal};

#[test]
fn copper_gains_0_393_percent_per_kelvin() {
    assert_eq!(resistance_ohm(2.0, 25.0), 2.0);
    assert!((resistance_ohm(2.0, 75.0) - 2.393).abs() < 1e-12);
}

#[test]
fn residual_is_what_the_cancellation_leaves() {
    assert!((residual_ohm(2.18, 2.071, 25.0) - 0.109).abs() < 1e-12);
    let hot = residual_ohm(2.18, 2.071, 82.0);
    assert!((hot - 0.5974).abs() < 1e-3, "{hot}");
}

#[test]
fn residual_of_a_cold_winding_stays_positive() {
    assert_eq!(residual_ohm(2.18, 2.071, -10.0), 0.01 * 2.18);
}

#[test]
fn continuous_current_warms_to_what_both_thermal_resistances_say() {
    let drive = spring_drive();
    let mut thermal = Thermal::new(&drive, 1.0);
    let current = V3::from(drive.current_continuous_a);
    for _ in 0..10_000 {
        thermal.step(&current);
    }
    for i in 0..3 {
        let winding_c = thermal.winding_c()[i];
        let loss_w = current[i].powi(2) * resistance_ohm(drive.r_25_ohm[i], winding_c);
        let expected_c = 25.0 + loss_w * (3.1 + 14.0);
        assert!(
            (winding_c - expected_c).abs() < 0.01,
            "{winding_c} {expected_c}"
        );
    }
    assert!(!thermal.hot());
}

#[test]
fn winding_follows_with_its_own_time_constant() {
    let drive = spring_drive();
    let mut thermal = Thermal::new(&drive, 1e-3);
    for _ in 0..12_000 {
        thermal.step(&V3::new(1.0, 0.0, 0.0));
    }
    let rise_k = thermal.winding_c()[0] - 25.0;
    let settled_k = 2.18 * 3.1;
    let expected_k = settled_k * (1.0 - (-1.0_f64).exp());
    assert!((rise_k - expected_k).abs() < 0.05 * settled_k, "{rise_k}");
    assert_eq!(thermal.winding_c()[1], 25.0);
}

#[test]
fn case_follows_with_its_own_time_constant() {
    let drive = spring_drive();
    let mut thermal = Thermal::new(&drive, 0.1);
    for _ in 0..6120 {
        thermal.step(&V3::new(1.0, 0.0, 0.0));
    }
    let rise_k = thermal.winding_c()[0] - 25.0;
    let loss_w = resistance_ohm(2.18, thermal.winding_c()[0]);
    let expected_k = loss_w * (3.1 + 14.0 * (1.0 - (-1.0_f64).exp()));
    assert!(
        (rise_k - expected_k).abs() < 0.1 * expected_k,
        "{rise_k} {expected_k}"
    );
}

#[test]
fn any_winding_past_its_limit_is_hot() {
    let drive = spring_drive();
    for joint in 0..3 {
        let mut thermal = Thermal::new(&drive, 1.0);
        let mut current = V3::zeros();
        current[joint] = 7.5;
        let mut seconds = 0;
        while !thermal.hot() {
            thermal.step(&current);
            seconds += 1;
            assert!(seconds < 60, "never hot");
        }
        assert!(thermal.winding_c()[joint] > 100.0);
    }
}

#[test]
fn drive_reports_its_own_residual() {
    let drive = spring_drive();
    let thermal = Thermal::new(&drive, 1.0);
    assert!((thermal.residual_ohm() - tuned_residual_ohm(&drive)).norm() < 1e-12);
}

#[test]
fn gains_fall_only_where_the_residual_is_below_the_tuned_one() {
    let mut drive = spring_drive();
    drive.k_d_v_s_per_rad = [0.02; 3];
    let tuned = tuned_residual_ohm(&drive);
    assert_eq!(never_stiffer(&drive, &tuned), drive);
    let mixed = V3::new(0.5 * tuned[0], 2.0 * tuned[1], tuned[2]);
    let reduced = never_stiffer(&drive, &mixed);
    assert!((reduced.k_p_v_per_rad[0] - 0.5 * drive.k_p_v_per_rad[0]).abs() < 1e-12);
    assert!((reduced.k_d_v_s_per_rad[0] - 0.01).abs() < 1e-12);
    assert_eq!(reduced.k_p_v_per_rad[1..], drive.k_p_v_per_rad[1..]);
    assert_eq!(reduced.k_d_v_s_per_rad[1..], drive.k_d_v_s_per_rad[1..]);
}

fn ambient(ambient_c: f64) -> DeviceModel {
    let mut model = phantom();
    if let DriveModel::Spring(drive) = &mut model.drive {
        drive.thermal.ambient_c = ambient_c;
    }
    model
}

#[test]
fn hot_motors_render_softer_and_say_so() {
    let (cold, hot) = (
        Rig::pressing(phantom(), 0.001),
        Rig::pressing(ambient(60.0), 0.001),
    );
    assert!(hot.record.stiffness_n_per_m < 0.5 * cold.record.stiffness_n_per_m);
    let force_n = V3::from(hot.record.tip_force_n).norm();
    let promised_n = hot.record.stiffness_n_per_m * hot.record.contact_depth_m;
    assert!((force_n - promised_n).abs() < 1e-3 * promised_n);
}

#[test]
fn cold_motors_render_no_stiffer_than_tuned() {
    let (tuned, cold) = (
        Rig::pressing(phantom(), 0.001),
        Rig::pressing(ambient(10.0), 0.001),
    );
    let ratio = cold.record.stiffness_n_per_m / tuned.record.stiffness_n_per_m;
    assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
    let forces = [&tuned, &cold].map(|rig| V3::from(rig.record.tip_force_n).norm());
    assert!(forces[1] < 1.02 * forces[0]);
}

#[test]
fn winding_past_its_limit_fades_the_outputs() {
    let mut model = phantom();
    if let DriveModel::Spring(drive) = &mut model.drive {
        drive.thermal.winding_max_c = 26.0;
    }
    let mut rig = Rig::pressing(model, 0.002);
    for _ in 0..5000 {
        rig.step();
    }
    assert!(rig.has(Fault::MotorHot));
    assert!(!rig.command.enable);
}
