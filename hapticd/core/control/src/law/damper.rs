//! A linear damper against penetration (KS Fig. 7a).

/// F = B v, N, at most `max_n`; none outwards.
#[must_use]
pub fn force(damping_n_s_per_m: f64, closing_m_per_s: f64, max_n: f64) -> f64 {
    (damping_n_s_per_m * closing_m_per_s.max(0.0)).min(max_n)
}
