//! The cubic damper against penetration (KS §4, Fig. 7).

use super::Tip;
use crate::scene::CubicForm;

/// Newton steps at most. The start is within a factor 1.32 of the solution and convergence is
/// quadratic, so that five reach the rounding.
const NEWTON_STEPS: usize = 8;

/// Force, N, on a tip that goes in at `closing_m_per_s`, at most the tip's limit; none outwards.
#[must_use]
pub fn force(c: f64, form: CubicForm, closing_m_per_s: f64, tip: &Tip) -> f64 {
    let v = closing_m_per_s.max(0.0);
    let unbounded_n = match form {
        CubicForm::Explicit => explicit(c, v),
        CubicForm::Implicit => implicit(c, v, tip.damping_max_n_s_per_m),
    };
    unbounded_n.min(tip.force_max_n)
}

/// F = C v³ as printed (KS §4). Its slope 3Cv² outgrows what a sampled loop can damp, so that it
/// chatters from about 15 to 40 mm/s at C = 1 600 000 N·s³/m³ (physics §6).
#[must_use]
pub fn explicit(c: f64, v: f64) -> f64 {
    c * v.powi(3)
}

/// F = C w³ with w from C w³ + (m/T_e) w = (m/T_e) v: w is the speed that is left once the force
/// has acted for T_e on the mass. Its slope never passes `m_per_t` = m/T_e, N·s/m.
#[must_use]
pub fn implicit(c: f64, v: f64, m_per_t: f64) -> f64 {
    if c <= 0.0 || v <= 0.0 || m_per_t <= 0.0 {
        return 0.0;
    }
    explicit(c, speed_left(c, v, m_per_t))
}

/// The root w of C w³ + (m/T_e)(w − v), in 0…v. The function is convex and rising there, so that
/// Newton's method from above falls monotonically to it.
fn speed_left(c: f64, v: f64, m_per_t: f64) -> f64 {
    // Either term alone must not pass the right-hand side.
    let mut w = v.min((m_per_t * v / c).cbrt());
    for _ in 0..NEWTON_STEPS {
        let excess = c * w.powi(3) + m_per_t * (w - v);
        let next = w - excess / (3.0 * c * w * w + m_per_t);
        if next >= w {
            break;
        }
        w = next;
    }
    w
}
