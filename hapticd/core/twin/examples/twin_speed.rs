//! Prints how much faster than real time each twin runs: `cargo run --release -p hapticd-twin --example twin_speed`.

#[path = "../tests/physics/models.rs"]
mod models;

use hapticd_control::io::Command;
use hapticd_twin::{Script, Twin};
use std::time::Instant;

const RATE_HZ: f64 = 1000.0;

/// Ticks in one measurement.
const TICKS: u32 = 250;

/// Measurements; the best of them is the one that other processes disturbed least.
const REPEATS: u32 = 40;

fn main() {
    for (name, (device, model)) in [("phantom-1.0", models::phantom()), ("hhd", models::hhd())] {
        match Twin::new(&device, &model, RATE_HZ, 1) {
            Ok(twin) => println!(
                "twin {name}: {:.0} times real time at {RATE_HZ} Hz",
                speed(twin)
            ),
            Err(error) => println!("twin {name}: {error}"),
        }
    }
}

/// Simulated over elapsed time, with the hand swinging and the motors working.
fn speed(mut twin: Twin) -> f64 {
    twin.hand(Script::Stroke {
        center_m: twin.truth().tip_position_m,
        axis: [0.0, 1.0, 0.0],
        amplitude_m: 0.02,
        frequency_hz: 2.0,
    });
    let command = Command {
        enable: true,
        motor_v: [0.1, -0.1, 0.1],
        motor_torque_nm: [0.5, -0.5, 0.0],
        brake_torque_nm: [1.0, 1.0, 0.0],
    };
    let elapsed_s = (0..REPEATS).map(|_| {
        let start = Instant::now();
        for _ in 0..TICKS {
            twin.step(&command);
        }
        start.elapsed().as_secs_f64()
    });
    f64::from(TICKS) / RATE_HZ / elapsed_s.fold(f64::INFINITY, f64::min)
}
