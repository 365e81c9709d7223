//! One wall: what its law gives for a depth and a speed.

use crate::models::{hhd, phantom};
use hapticd_control::law::cubic::{explicit, implicit};
use hapticd_control::law::sampled_loop::SampledLoop;
use hapticd_control::law::spring::damper_share;
use hapticd_control::law::{damper_force, eta, Tip};
use hapticd_control::linear::V3;
use hapticd_control::scene::{CubicForm, Law};
use proptest::prelude::*;

const PERIOD_S: f64 = 1e-3;
const PRINTED: f64 = 1.6e6;

fn any_damper() -> impl Strategy<Value = Law> {
    let cubic = |form| {
        (3.0..9.0_f64).prop_map(move |exponent| Law::CubicDamper {
            coefficient_n_s3_per_m3: 10_f64.powf(exponent),
            form,
        })
    };
    prop_oneof![
        (0.0..2000.0_f64).prop_map(|damping_n_s_per_m| Law::Damper { damping_n_s_per_m }),
        cubic(CubicForm::Explicit),
        cubic(CubicForm::Implicit),
    ]
}

proptest! {
    #[test]
    fn damper_pushes_against_penetration_alone_and_within_the_tips_limit(
        law in any_damper(), v in -3.0..3.0_f64,
    ) {
        let tip = Tip::new(&hhd(), PERIOD_S);
        let force_n = damper_force(&law, v, &tip);
        prop_assert!((0.0..=tip.force_max_n).contains(&force_n));
        prop_assert!(v > 0.0 || force_n == 0.0);
    }

    #[test]
    fn faster_penetration_never_meets_less(law in any_damper(), v in 0.0..3.0_f64, more in 0.0..1.0_f64) {
        let tip = Tip::new(&phantom(), PERIOD_S);
        prop_assert!(damper_force(&law, v + more, &tip) >= damper_force(&law, v, &tip) * (1.0 - 1e-12));
    }

    #[test]
    fn implicit_form_solves_its_equation(
        exponent in 0.0..10.0_f64, v in 1e-4..5.0_f64, m_per_t in 1.0..3000.0_f64,
    ) {
        let c = 10_f64.powf(exponent);
        let force_n = implicit(c, v, m_per_t);
        let w = (force_n / c).cbrt();
        prop_assert!((force_n + m_per_t * (w - v)).abs() <= 1e-9 * (m_per_t * v));
    }

    #[test]
    fn implicit_form_is_never_harder_than_the_explicit_one_nor_than_the_mass_allows(
        v in 1e-4..5.0_f64, more in 1e-4..0.1_f64, m_per_t in 1.0..3000.0_f64,
    ) {
        let force_n = implicit(PRINTED, v, m_per_t);
        prop_assert!(force_n <= explicit(PRINTED, v));
        let slope = (implicit(PRINTED, v + more, m_per_t) - force_n) / more;
        prop_assert!(slope <= m_per_t * (1.0 + 1e-6));
    }

    #[test]
    fn dampers_beside_a_spring_never_turn_it_into_a_pull(
        spring in prop::array::uniform3(-50.0..50.0_f64), damper in prop::array::uniform3(-90.0..90.0_f64),
    ) {
        let (spring, damper) = (V3::from(spring), V3::from(damper));
        let share = damper_share(&spring, &damper);
        prop_assert!((0.0..=1.0).contains(&share));
        prop_assert!((spring + share * damper).dot(&spring) >= -1e-9);
    }

    #[test]
    fn spring_is_granted_as_a_share_of_the_rigid_wall(k in 0.0..5000.0_f64, k_c in 1.0..5000.0_f64) {
        let law = Law::Spring { stiffness_n_per_m: k, damping_n_s_per_m: 0.0 };
        let granted = (1.0 - eta(&law, k_c, k_c)) * k_c;
        prop_assert!((granted - k.min(k_c)).abs() < 1e-9 * k_c);
    }
}

#[test]
fn printed_damper_gives_the_printed_force() {
    // KS Fig. 7: 100 N above 40 mm/s.
    assert!((explicit(PRINTED, 0.04) - 102.4).abs() < 1e-9);
}

/// Largest amplitude after 400 periods of a unit mass at 1 m/s with a sampled damper, its force
/// one exchange late, against its velocity through λ/(s+λ), behind a lag.
fn swing_m_per_s(damping: f64, behind: &SampledLoop) -> f64 {
    const SUBSTEPS: usize = 50;
    let h = behind.period_s / SUBSTEPS as f64;
    let keep = (-behind.lambda_rad_per_s * behind.period_s).exp();
    let (mut x, mut v, mut force) = (0.0, 1.0, 0.0);
    let (mut before, mut filtered, mut sent): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let mut largest: f64 = 0.0;
    for tick in 0..400 {
        let held = sent;
        filtered = keep * filtered + (1.0 - keep) / behind.period_s * (x - before);
        before = x;
        sent = -damping * filtered;
        for _ in 0..SUBSTEPS {
            force += (held - force) * (1.0 - (-h / behind.lag_s).exp());
            v += h * force;
            x += h * v;
        }
        largest = if tick < 380 {
            0.0
        } else {
            largest.max(v.abs())
        };
    }
    largest
}

#[test]
fn hardest_damper_damps_the_sampled_loop_and_a_third_more_swings_up() {
    for (period_s, lag_s) in [(1e-3, 5e-4), (5e-4, 5e-4), (2.5e-4, 5e-4), (1e-3, 2.2e-3)] {
        let behind = SampledLoop {
            period_s,
            lag_s,
            lambda_rad_per_s: 1256.6,
        };
        let hardest = behind.damping_max_per_s();
        let (damped, swung) = (
            swing_m_per_s(hardest, &behind),
            swing_m_per_s(1.34 * hardest, &behind),
        );
        assert!(damped < 0.1, "{damped}");
        assert!(swung > 1.0, "{swung}");
    }
}

#[test]
fn hardest_damper_of_a_device_is_that_of_its_mass_period_lag_and_filter() {
    let hardest = Tip::new(&hhd(), PERIOD_S).damping_max_n_s_per_m;
    assert!((hardest - 532.7).abs() < 0.1, "{hardest}");
    let mut heavier = hhd();
    heavier.tip.mass_kg *= 2.0;
    let twice = Tip::new(&heavier, PERIOD_S).damping_max_n_s_per_m;
    assert!((twice - 2.0 * hardest).abs() < 1e-9);
    assert!(Tip::new(&hhd(), 0.5 * PERIOD_S).damping_max_n_s_per_m > hardest);
}
