//! The spring drive's circuit against its closed forms (WN §II).

use crate::models;
use hapticd_control::model::{DriveModel, SpringDriveModel};
use hapticd_twin::model::WindingTwinModel;
use hapticd_twin::winding::Winding;
use hapticd_twin::TwinModel;

/// Step of the shipped twin at 1 kHz, s.
const H: f64 = 5e-5;

fn parts() -> (SpringDriveModel, WindingTwinModel) {
    match models::phantom() {
        (device, TwinModel::Phantom(twin)) => match device.drive {
            DriveModel::Spring(drive) => (
                drive,
                WindingTwinModel {
                    brush_ripple: 0.0,
                    ..twin.winding
                },
            ),
            DriveModel::Torque(_) => unreachable!("the PHANTOM has spring drives"),
        },
        _ => unreachable!("the shipped PHANTOM has a PHANTOM twin"),
    }
}

fn cold() -> Winding {
    let (drive, model) = parts();
    Winding::new(&drive, &model, 1)
}

/// Torque after `duration_s` at a standstill under `e_w`.
fn stalled(winding: &mut Winding, e_w: f64, duration_s: f64) -> f64 {
    (0..(duration_s / H) as usize).fold(0.0, |_, _| winding.drive(e_w, 0.0, 0.0, H))
}

#[test]
fn static_torque_is_k_t_e_w_over_the_residual_resistance() {
    let (drive, _) = parts();
    let d_r = drive.r_25_ohm[1] - drive.r_hat_ohm[1];
    let torque = stalled(&mut cold(), 0.1, 0.05);
    assert!((torque / (drive.k_t_nm_per_a[1] * 0.1 / d_r) - 1.0).abs() < 1e-3);
}

#[test]
fn current_rises_with_the_time_constant_of_the_residual_circuit() {
    let (drive, _) = parts();
    let tau = drive.l_h[1] / (drive.r_25_ohm[1] - drive.r_hat_ohm[1]);
    let settled = stalled(&mut cold(), 0.1, 20.0 * tau);
    let risen = stalled(&mut cold(), 0.1, tau);
    assert!((risen / settled - (1.0 - (-1.0_f64).exp())).abs() < 0.02);
}

#[test]
fn a_sudden_turn_meets_the_spring_of_the_inductance() {
    // WN eq. 9: at high frequency the motor is a spring k_T²/L, whatever the gains.
    let (drive, _) = parts();
    let mut winding = cold();
    let turn_rad = 1e-3;
    let steps = 4;
    let omega = turn_rad / (f64::from(steps) * H);
    let torque = (0..steps).fold(0.0, |_, _| winding.drive(0.0, 0.0, omega, H));
    let spring = drive.k_t_nm_per_a[1].powi(2) / drive.l_h[1];
    assert!(
        (torque / (-spring * turn_rad) - 1.0).abs() < 0.06,
        "{torque}"
    );
}

#[test]
fn matching_back_emf_leaves_a_turning_motor_free() {
    let (drive, _) = parts();
    let omega = 50.0;
    let mut winding = cold();
    let torque = (0..1000).fold(0.0, |_, _| {
        winding.drive(drive.k_t_nm_per_a[1] * omega, 0.0, omega, H)
    });
    assert!(torque.abs() < 1e-12);
}

#[test]
fn current_stays_inside_the_amplifier_limit_and_the_supply() {
    let (drive, model) = parts();
    let mut winding = cold();
    stalled(&mut winding, 24.0, 0.01);
    assert!((winding.current_a - drive.current_max_a[1]).abs() < 1e-9);
    let weak = WindingTwinModel {
        supply_v: 5.0,
        ..model
    };
    let mut winding = Winding::new(&drive, &weak, 1);
    stalled(&mut winding, 24.0, 0.01);
    assert!((winding.current_a - 5.0 / drive.r_25_ohm[1]).abs() < 0.02);
}

#[test]
fn a_disabled_bridge_loses_its_current_within_a_tenth_of_a_millisecond() {
    let mut winding = cold();
    stalled(&mut winding, 0.5, 0.05);
    assert!(winding.current_a > 4.0);
    winding.release(0.0, H);
    assert_eq!(winding.release(0.0, H), 0.0);
}

#[test]
fn rated_current_warms_the_winding_as_the_data_sheet_says() {
    let (drive, model) = parts();
    let mut winding = Winding::new(&drive, &model, 1);
    let d_r = |w: &Winding| w.resistance_ohm(0.0) - drive.r_hat_ohm[1];
    let rated = drive.current_continuous_a[1];
    // Large steps are fine: the current follows e_W = dR i at once, the heat takes minutes.
    for _ in 0..60_000 {
        let e_w = rated * d_r(&winding);
        winding.current_a = rated;
        winding.drive(e_w, 0.0, 0.0, 0.1);
        winding.heat(0.1);
    }
    let t = drive.thermal;
    let resistance = t.winding_case_k_per_w + t.case_ambient_k_per_w;
    let loss_w = rated * rated * winding.resistance_ohm(0.0);
    assert!(
        (winding.winding_c - t.ambient_c - resistance * loss_w).abs() < 0.5,
        "{}",
        winding.winding_c
    );
    // Physics: about 57 K cold loss, more with the resistance it raises itself.
    assert!((57.0..80.0).contains(&(winding.winding_c - t.ambient_c)));
}

#[test]
fn brush_ripple_moves_the_resistance_by_its_share() {
    let (drive, model) = parts();
    let rippled = Winding::new(
        &drive,
        &WindingTwinModel {
            brush_ripple: 0.03,
            ..model
        },
        1,
    );
    let over_a_turn: Vec<f64> = (0..1000)
        .map(|i| rippled.resistance_ohm(f64::from(i) * 6.2832e-3))
        .collect();
    let high = over_a_turn.iter().copied().fold(f64::MIN, f64::max);
    let low = over_a_turn.iter().copied().fold(f64::MAX, f64::min);
    assert!((high / drive.r_25_ohm[1] - 1.03).abs() < 1e-3);
    assert!((low / drive.r_25_ohm[1] - 0.97).abs() < 1e-3);
}
