//! What is timed against CHAI3D gives the forces that CHAI3D gives there.

#[path = "../../examples/tick_bench/chai3d.rs"]
mod workload;

use hapticd_control::linear::V3;
use workload::{scene, tip, Force, MOTIONS, SIZES};

const TICKS: u64 = 100_000;

#[test]
fn one_box_pushes_as_penalty_walls_do() {
    let (count, reach_m) = SIZES[0];
    let expected = [
        ("free", 0.0, 0.0),
        ("mixed", 2.0 / std::f64::consts::PI, 0.5),
        ("press", 1.0, 1.0),
    ];
    for ((name, height), (same, mean_n, share)) in MOTIONS.into_iter().zip(expected) {
        assert_eq!(name, same);
        let mut force = Box::new(Force::of(&scene(count, &V3::zeros())));
        let (mut sum_n, mut touching) = (0.0, 0);
        for tick in 0..TICKS {
            let force_n = force.at(&tip(reach_m, height, tick));
            assert!(force_n.z >= 0.0 && force_n.xy().norm() < 1e-9, "{force_n}");
            sum_n += force_n.norm();
            touching += u32::from(force_n.norm() > 1e-9);
        }
        let ticks = TICKS as f64;
        assert!((sum_n / ticks - mean_n).abs() < 1e-3, "{name}: {sum_n}");
        assert!((f64::from(touching) / ticks - share).abs() < 0.01, "{name}");
    }
}
