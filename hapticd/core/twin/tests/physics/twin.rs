//! The twin as the loop sees it: repeatability, sensors, actuators, injected faults.

use crate::models;
use crate::rig::{brakes, Rig, RATE_HZ};
use assert_no_alloc::{assert_no_alloc, AllocDisabler};
use hapticd_control::io::{status, Command, Exchange, Observation};
use hapticd_control::linear::V3;
use hapticd_twin::{Injection, Script, Twin, TwinError, TwinModel};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Observations of a run in which everything happens.
fn busy_run(mut rig: Rig) -> Vec<(Exchange, Observation)> {
    let tip: [f64; 3] = rig.tip().into();
    rig.twin.hand(Script::Stroke {
        center_m: tip,
        axis: [1.0, 1.0, 0.0],
        amplitude_m: 0.02,
        frequency_hz: 3.0,
    });
    rig.twin.inject(Injection::DropFrames {
        fraction: 0.2,
        duration_s: 0.5,
    });
    let command = Command {
        enable: true,
        motor_v: [0.05, -0.1, 0.1],
        motor_torque_nm: [0.5, -0.5, 0.0],
        brake_torque_nm: [2.0, 1.0, 0.0],
    };
    (0..500).map(|_| rig.twin.step(&command)).collect()
}

#[test]
fn the_same_seed_repeats_a_run_bit_by_bit() {
    for models in [models::phantom, models::hhd] {
        assert_eq!(
            busy_run(Rig::new(models(), 7)),
            busy_run(Rig::new(models(), 7))
        );
    }
}

#[test]
fn another_seed_gives_another_run() {
    for models in [models::phantom, models::hhd] {
        assert_ne!(
            busy_run(Rig::new(models(), 7)),
            busy_run(Rig::new(models(), 8))
        );
    }
}

#[test]
fn a_step_allocates_nothing() {
    for mut rig in [Rig::phantom(), Rig::hhd()] {
        let tip: [f64; 3] = rig.tip().into();
        assert_no_alloc(|| {
            rig.twin.hand(Script::MinimumJerk {
                from_m: tip,
                to_m: tip,
                duration_s: 0.1,
            });
            rig.twin.inject(Injection::DropFrames {
                fraction: 0.5,
                duration_s: 0.1,
            });
            rig.run(0.2, &brakes(3.0));
        });
    }
}

#[test]
fn frames_count_up_at_the_tick_rate_and_counts_are_the_joint_angles() {
    for mut rig in [Rig::phantom(), Rig::hhd()] {
        let (exchange, first) = rig.rest(0.001);
        let (_, last) = rig.rest(0.1);
        assert_eq!(exchange, Exchange::Fresh);
        assert_eq!(last.seq - first.seq, 100);
        assert_eq!(last.t_device_ns - first.t_device_ns, 100_000_000);
        for axis in 0..rig.device.dof {
            let angle = last.counts[axis] as f64 / rig.device.joints.counts_per_rad[axis];
            let error = angle - rig.twin.truth().joint_position_rad[axis];
            assert!(error.abs() <= 0.5001 / rig.device.joints.counts_per_rad[axis]);
        }
    }
}

#[test]
fn an_observation_does_not_know_the_command_it_is_exchanged_for() {
    let mut pushed = Rig::phantom();
    let mut rested = Rig::phantom();
    let command = Command {
        enable: true,
        motor_v: [0.5, 0.5, 0.5],
        ..Command::default()
    };
    assert_eq!(
        pushed.twin.step(&command),
        rested.twin.step(&Command::default())
    );
    assert_ne!(
        pushed.twin.step(&command),
        rested.twin.step(&Command::default())
    );
}

#[test]
fn a_command_delay_shifts_the_response_by_its_ticks() {
    let first_current = |delay: u32| {
        let (device, model) = models::phantom();
        let TwinModel::Phantom(mut twin) = model else {
            unreachable!("the PHANTOM has a PHANTOM twin")
        };
        twin.command_delay_ticks = delay;
        let mut rig = Rig::new((device, TwinModel::Phantom(twin)), 1);
        let command = Command {
            enable: true,
            motor_v: [0.1; 3],
            ..Command::default()
        };
        (0..20).find(|_| rig.twin.step(&command).1.motor_current_a[0] != 0.0)
    };
    assert_eq!(first_current(0), Some(1));
    assert_eq!(first_current(3), Some(4));
}

#[test]
fn a_device_that_is_off_stays_where_it_is() {
    for mut rig in [Rig::phantom(), Rig::hhd()] {
        let start = rig.tip();
        rig.rest(2.0);
        assert!((rig.tip() - start).norm() < 1e-6);
    }
}

#[test]
fn a_disabled_command_moves_nothing_whatever_it_asks() {
    for mut rig in [Rig::phantom(), Rig::hhd()] {
        let start = rig.tip();
        let command = Command {
            motor_v: [5.0; 3],
            motor_torque_nm: [5.0; 3],
            ..Command::default()
        };
        let (_, observation) = rig.run(0.5, &command);
        assert!((rig.tip() - start).norm() < 1e-6);
        assert_eq!(observation.status & status::OUTPUTS_LIVE, 0);
    }
}

#[test]
fn stops_hold_the_linkage_against_a_strong_hand() {
    for (mut rig, force_n) in [(Rig::phantom(), 20.0), (Rig::hhd(), 100.0)] {
        for direction in [
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.3],
        ] {
            rig.push(direction, force_n);
            rig.rest(2.0);
            let q = V3::from(rig.twin.truth().joint_position_rad);
            assert!(
                rig.device.kinematics.inside(&rig.device.joints, &q, 0.15),
                "{direction:?}: {q}"
            );
        }
    }
}

#[test]
fn a_held_brake_sticks_and_a_released_one_slips() {
    let mut rig = Rig::hhd();
    rig.run(0.5, &brakes(10.0));
    let start = rig.tip();
    rig.push([0.0, -1.0, 0.0], 30.0);
    rig.run(1.0, &brakes(10.0));
    assert!((rig.tip() - start).norm() < 1e-5, "{}", rig.tip() - start);
    rig.run(0.5, &brakes(0.0));
    assert!((rig.tip() - start).norm() > 0.01);
}

#[test]
fn a_brake_takes_energy_out_and_never_puts_any_in() {
    let mut rig = Rig::hhd();
    let tip: [f64; 3] = rig.tip().into();
    rig.twin.hand(Script::Stroke {
        center_m: tip,
        axis: [0.3, 1.0, 0.0],
        amplitude_m: 0.03,
        frequency_hz: 1.0,
    });
    for tick in 0..3000 {
        rig.run(0.001, &brakes(if tick % 400 < 200 { 4.0 } else { 0.0 }));
        let truth = rig.twin.truth();
        for axis in 0..2 {
            let power = truth.brake_torque_nm[axis] * truth.joint_velocity_rad_per_s[axis];
            // Four Gauss–Seidel sweeps leave a stuck joint creeping at most this much.
            assert!(power <= 1e-7, "tick {tick}: {power} W");
        }
    }
}

#[test]
fn motor_torque_reaches_the_tip_of_the_hhd() {
    let mut rig = Rig::hhd();
    rig.rest(0.001);
    let point = rig.tip();
    rig.twin.hand(Script::Clamp {
        position_m: point.into(),
    });
    rig.rest(0.3);
    let command = Command {
        enable: true,
        motor_torque_nm: [4.0, -4.0, 0.0],
        ..Command::default()
    };
    let (_, observation) = rig.run(0.5, &command);
    // Radial: τ = F l sin(δ/2) on each joint, less at most the friction of 1.4 N·m.
    let arm_m = 0.2 * (std::f64::consts::PI / 3.0).sin();
    let outward = -rig.hand_force().y;
    assert!((outward - 4.0 / arm_m).abs() < 1.4 / arm_m, "{outward}");
    // The sensor's bias, noise and resolution are a few tenths of a newton.
    let measured = V3::from(observation.force_n);
    assert!((measured - rig.hand_force()).norm() < 0.8, "{measured}");
}

#[test]
fn an_unplugged_device_is_down_and_comes_back() {
    let mut rig = Rig::phantom();
    rig.twin.inject(Injection::Unplug { duration_s: 0.05 });
    let command = Command {
        enable: true,
        motor_v: [0.2; 3],
        ..Command::default()
    };
    let exchanges: Vec<_> = (0..60).map(|_| rig.twin.step(&command)).collect();
    assert!(exchanges[..50]
        .iter()
        .all(|(exchange, _)| *exchange == Exchange::Down));
    assert!(exchanges[50..]
        .iter()
        .all(|(exchange, _)| *exchange == Exchange::Fresh));
    assert_eq!(
        exchanges[50].1.motor_current_a, [0.0; 3],
        "its amplifiers had no supply"
    );
}

#[test]
fn silence_repeats_the_last_observation_while_commands_still_act() {
    let mut rig = Rig::phantom();
    let (_, before) = rig.rest(0.01);
    rig.twin.inject(Injection::Silence { duration_s: 0.02 });
    let command = Command {
        enable: true,
        motor_v: [0.2; 3],
        ..Command::default()
    };
    let (exchange, during) = rig.run(0.02, &command);
    assert_eq!((exchange, during), (Exchange::Missing, before));
    let (exchange, after) = rig.run(0.001, &command);
    assert_eq!(exchange, Exchange::Fresh);
    assert_eq!(
        after.seq,
        before.seq + 21,
        "the lost frames show in the frame counter"
    );
    assert!(after.counts[0] > before.counts[0] + 10);
}

#[test]
fn dropped_frames_have_their_share() {
    let mut rig = Rig::hhd();
    rig.twin.inject(Injection::DropFrames {
        fraction: 0.3,
        duration_s: 2.0,
    });
    let missing = (0..2000)
        .filter(|_| rig.twin.step(&Command::default()).0 == Exchange::Missing)
        .count();
    assert!((500..700).contains(&missing), "{missing}");
}

#[test]
fn injected_sensor_faults_show_and_heal() {
    let shows = |injection, check: fn(&Observation, &Observation) -> bool| {
        let mut rig = Rig::hhd();
        let (_, before) = rig.rest(0.01);
        rig.twin.inject(injection);
        let (_, during) = rig.rest(0.01);
        let (_, after) = rig.rest(0.1);
        check(&during, &before) && !check(&after, &before)
    };
    let duration_s = 0.05;
    assert!(shows(Injection::NotFinite { duration_s }, |now, _| now
        .force_n[0]
        .is_nan()));
    assert!(shows(
        Injection::EncoderJump { duration_s },
        |now, was| (now.counts[0] - was.counts[0]).abs() > 10_000
    ));
    assert!(shows(Injection::EstopInput { duration_s }, |now, _| now
        .status
        & status::ESTOP_INPUT
        != 0));
    assert!(shows(
        Injection::SensorSaturated { duration_s },
        |now, _| { now.status & status::SENSOR_SATURATED != 0 && now.force_n[0] == 300.0 }
    ));
    assert!(shows(
        Injection::AmplifierFault { duration_s },
        |now, _| now.status & status::AMPLIFIER_FAULT != 0
    ));
}

#[test]
fn models_that_do_not_fit_are_refused_with_the_reason() {
    let (phantom, phantom_twin) = models::phantom();
    let (hhd, _) = models::hhd();
    let mismatch = Twin::new(&hhd, &phantom_twin, RATE_HZ, 1).err();
    assert!(matches!(mismatch, Some(TwinError::Mismatch(_))));
    let TwinModel::Phantom(mut twin) = phantom_twin else {
        unreachable!("the PHANTOM has a PHANTOM twin")
    };
    twin.hand.mass_kg = 0.0;
    let massless = Twin::new(&phantom, &TwinModel::Phantom(twin), RATE_HZ, 1).err();
    assert_eq!(
        massless.map(|error| error.to_string()).as_deref(),
        Some("twin.hand.mass_kg is 0, it has to be positive")
    );
    let coarse = Twin::new(&phantom, &phantom_twin, 100.0, 1).err();
    assert!(coarse.is_some_and(|error| error.to_string().contains("substeps")));
}
