//! The probe on a device whose tip is locked.

use crate::models::{hhd, phantom, spring_drive, torque_drive};
use crate::rig::{scene, Rig, RATE_HZ};
use core::f64::consts::TAU;
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::{Probe, Scene};

const HZ: f64 = 10.0;

fn probing(model: DeviceModel, amplitude_m: f64) -> Rig {
    let mut rig = Rig::running(model);
    let probe = Probe {
        direction: [0.6, 0.8, 0.0],
        amplitude_m,
        frequency_hz: HZ,
    };
    rig.controller.adopt(&Scene {
        probe: Some(probe),
        ..scene(&[], 0.05)
    });
    rig.steps(200);
    rig
}

/// Amplitudes of the sine and the cosine of the demanded force along the probe, and the largest
/// force across it, N, over one second.
fn response(rig: &mut Rig) -> (f64, f64) {
    let along = V3::new(0.6, 0.8, 0.0);
    let (mut sine, mut cosine, mut across_n): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for tick in 0..1000 {
        rig.step();
        let force_n = V3::from(rig.record.tip_force_command_n);
        let phase = TAU * HZ * f64::from(tick) / RATE_HZ;
        sine += force_n.dot(&along) * phase.sin() * 2e-3;
        cosine += force_n.dot(&along) * phase.cos() * 2e-3;
        across_n = across_n.max((force_n - force_n.dot(&along) * along).norm());
    }
    (sine.hypot(cosine), across_n)
}

#[test]
fn force_of_a_locked_tip_follows_the_closed_form() {
    let omega = TAU * HZ;
    let mut rig = probing(hhd(), 2e-4);
    let drive = torque_drive();
    let expected_n = 2e-4
        * drive
            .stiffness_n_per_m
            .hypot(drive.damping_n_s_per_m * omega);
    let (amplitude_n, across_n) = response(&mut rig);
    assert!(
        (amplitude_n - expected_n).abs() < 1e-3 * expected_n,
        "{amplitude_n}"
    );
    assert!(across_n < 1e-6);

    let mut rig = probing(phantom(), 5e-4);
    let k_c = rig.record.stiffness_n_per_m;
    // K_θ = k_T (K_P + s k_T)/dR of the static circuit, against K_P alone at rest.
    let gain = spring_drive();
    let rate = gain.k_t_nm_per_a[0] * omega / gain.k_p_v_per_rad[0];
    let expected_n = 5e-4 * k_c * 1_f64.hypot(rate);
    let (amplitude_n, across_n) = response(&mut rig);
    assert!(
        (amplitude_n - expected_n).abs() < 1e-2 * expected_n,
        "{amplitude_n} of {expected_n}"
    );
    assert!(across_n < 1e-3 * expected_n);
}

#[test]
fn probe_comes_in_smoothly_and_stays_within_the_tips_limit() {
    for model in [hhd(), phantom()] {
        let limit_n = model.limits.tip_force_n;
        let mut rig = probing(model, 1.0);
        for _ in 0..200 {
            rig.step();
            assert!(V3::from(rig.record.tip_force_command_n).norm() <= limit_n * (1.0 + 1e-6));
        }
        assert_eq!(rig.record.brake_torque_nm, [0.0; 3], "motors alone excite");
    }
}
