//! Prints how much faster than real time each twin runs: `cargo run --release -p hapticd-twin --example twin_speed`.

#[path = "../tests/physics/models.rs"]
mod models;

use hapticd_control::io::Command;
use hapticd_twin::{Script, Twin};
use std::time::Instant;

const RATE_HZ: f64 = 1000.0;
const SIMULATED_S: f64 = 5.0;

fn main() {
    for (name, (device, model)) in [("phantom-1.0", models::phantom()), ("hhd", models::hhd())] {
        match Twin::new(&device, &model, RATE_HZ, 1) {
            Ok(twin) => println!("{name}: {:.0} times real time at {RATE_HZ} Hz", speed(twin)),
            Err(error) => println!("{name}: {error}"),
        }
    }
}

/// Simulated over elapsed time, with the hand swinging and the motors working.
fn speed(mut twin: Twin) -> f64 {
    let tip = twin.truth().tip_position_m;
    twin.hand(Script::Stroke {
        center_m: tip,
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
    let start = Instant::now();
    for _ in 0..(SIMULATED_S * RATE_HZ) as u64 {
        twin.step(&command);
    }
    SIMULATED_S / start.elapsed().as_secs_f64()
}
