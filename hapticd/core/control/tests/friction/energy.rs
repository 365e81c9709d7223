//! Friction gives back no more than what its anchors hold.

use crate::rubber::{device, path, surface, wall, Rubber};
use hapticd_control::linear::V3;
use proptest::prelude::*;

proptest! {
    #[test]
    fn work_on_the_tip_never_exceeds_what_the_anchor_gives_up(
        model in device(), (n, _) in surface(), path in path(),
    ) {
        let mut rubber = Rubber::new(&model);
        for (step_m, normal_n) in path {
            let held_j = rubber.friction.energy_j();
            let found = rubber.step(&step_m, &[wall(1, n, normal_n)], None);
            let given_j = found.motor_n.dot(&step_m);
            let released_j = held_j - rubber.friction.energy_j();
            prop_assert!(given_j <= released_j + 1e-12, "{given_j} of {released_j}");
        }
    }

    #[test]
    fn closed_loops_cost_energy(model in device(), (n, _) in surface(), path in path()) {
        let mut rubber = Rubber::new(&model);
        let mut given_j = 0.0;
        let back = path.iter().rev().map(|(step_m, normal_n)| (-step_m, *normal_n));
        for (step_m, normal_n) in path.iter().copied().chain(back) {
            let found = rubber.step(&step_m, &[wall(1, n, normal_n)], None);
            given_j += found.motor_n.dot(&step_m);
        }
        prop_assert!(given_j <= 1e-12, "{given_j}");
    }

    #[test]
    fn several_walls_hold_the_energy_bound_together(
        model in device(), (n, t) in surface(), path in path(),
    ) {
        let mut rubber = Rubber::new(&model);
        let tilted = (n + 0.7 * t).normalize();
        for (step_m, normal_n) in path {
            let held_j = rubber.friction.energy_j();
            let walls = [wall(1, n, normal_n), wall(2, t, 50.0 - normal_n), wall(3, tilted, 5.0)];
            let given_j = rubber.step(&step_m, &walls, None).motor_n.dot(&step_m);
            prop_assert!(given_j <= held_j - rubber.friction.energy_j() + 1e-12);
        }
    }

    #[test]
    fn wall_that_lets_go_takes_the_stretch_with_it(
        model in device(), (n, t) in surface(), from_n in 5.0..50.0_f64,
    ) {
        let mut rubber = Rubber::new(&model);
        rubber.steps(100, &(1e-5 * t), &[wall(1, n, from_n)]);
        let mut held_j = rubber.friction.energy_j();
        prop_assert!(held_j > 0.0);
        for tick in (0..50).rev() {
            let normal_n = from_n * f64::from(tick) / 50.0;
            rubber.step(&V3::zeros(), &[wall(1, n, normal_n)], None);
            prop_assert!(rubber.friction.energy_j() <= held_j * (1.0 + 1e-12));
            held_j = rubber.friction.energy_j();
        }
        prop_assert_eq!(held_j, 0.0);
    }
}
