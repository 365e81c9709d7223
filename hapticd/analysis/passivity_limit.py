"""How stiff a wall may be and still return no energy: sampling, resolution, and the spring drive's own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Spectrum = NDArray[np.complex128]
Real = NDArray[np.float64]

ANGLES = 160
"""Frequencies looked at, from near 0 to the Nyquist frequency."""

ALIASES = 40
"""Images of each frequency on either side; what is left out of Σ 1/ω² is below 0.5 %."""

_ANGLE: NDArray[np.float64] = np.pi * (np.arange(ANGLES) + 1.0) / ANGLES


def colgate_schenkel_n_per_m(friction_n_s_per_m: float, damping_n_s_per_m: float, rate_hz: float) -> float:
    """Largest passive K of K + B(z−1)/(Tz) without delay: b > KT/2 + |B| (Colgate & Schenkel), N/m."""
    return max(0.0, 2.0 * rate_hz * (friction_n_s_per_m - abs(damping_n_s_per_m)))


def abbott_okamura_n_per_m(coulomb_n: float, quantum_m: float) -> float:
    """Largest K whose gain by quantisation Coulomb friction takes up: 2 f_c/Δ (Abbott & Okamura), N/m."""
    return 2.0 * coulomb_n / quantum_m


def spring_drive_is_passive(k_dc: float, k_hf: float) -> bool:
    """Whether the spring drive without K_D is passive in continuous time: K_DC ≤ K_HF (physics §2.1)."""
    return k_dc <= k_hf


@dataclass(frozen=True, slots=True)
class SampledWall:
    """A wall sampled at ``rate_hz``, its force ``delay_s`` late, in front of a device with friction b.

    The actuator is that of ``LinearLoop``: a lag τ_a and, in a spring drive, the series spring K_s, which
    with the residual resistance takes energy up like a friction of K_s τ_a/(1 + ω²τ_a²). Velocity is the
    estimator's: differences through λ/(s+λ).
    """

    friction_n_s_per_m: float
    rate_hz: float
    delay_s: float
    lag_s: float
    lambda_rad_per_s: float
    series_n_per_m: float = 0.0

    def largest_stiffness_n_per_m(self, damping_n_s_per_m: float) -> float:
        """Largest K that is passive together with B, N/m; 0 when not even K = 0 is.

        Colgate & Schenkel's derivation with delay d, actuator A and friction b(ω) kept. Motion at ω has
        images at ω_k = ω + 2πk/T. With u_k = A(ω_k) e^(−jω_k d)/(ω_k √b_k), w_k = 1/(ω_k √b_k) and
        c = (1−e^(−jωT)) H/T the wall gives at most ½(R + √(R² + G)) of what friction takes: R = Re c⟨w,u⟩,
        G = |c|² (|u|²|w|² − |⟨w,u⟩|²), the larger eigenvalue of a form of rank two. H = K + BV makes
        ½(R + √(R² + G)) ≤ 1 a quadratic α K² + β K + γ ≤ 0 at every frequency. Without delay, lag and series
        spring G = 0, and what is left is theirs: b ≥ (T/2)/(1−cos ωT) Re (1−e^(−jωT))H.
        """
        if self.friction_n_s_per_m <= 0.0:
            return 0.0
        product, spread = self._actuator()
        slope, velocity = self._sampling()
        damper, weight = damping_n_s_per_m * velocity, spread * np.abs(slope) ** 2
        beta = 2 * weight * damper.real + 4 * (product * slope).real
        gamma = weight * np.abs(damper) ** 2 + 4 * (product * slope * damper).real - 4
        return _largest_common(weight, beta, gamma)

    def _actuator(self) -> tuple[Spectrum, Real]:
        """⟨w,u⟩ and |u|²|w|² − |⟨w,u⟩|² at every angle."""
        images = _ANGLE[:, None] + 2 * np.pi * np.arange(-ALIASES, ALIASES + 1)
        omega = images * self.rate_hz
        lag = 1.0 + 1j * omega * self.lag_s
        late = np.exp(-1j * omega * self.delay_s) / lag
        friction = self.friction_n_s_per_m + self.series_n_per_m * self.lag_s / np.abs(lag) ** 2
        share = 1.0 / (omega**2 * friction)
        product = np.sum(late * share, axis=1)
        spread = np.sum(np.abs(late) ** 2 * share, axis=1) * np.sum(share, axis=1) - np.abs(product) ** 2
        return product, np.maximum(spread, 0.0)

    def _sampling(self) -> tuple[Spectrum, Spectrum]:
        """(1−e^(−jωT))/T and the velocity estimate of a position at every angle."""
        back = np.exp(-1j * _ANGLE)
        slope = (1 - back) * self.rate_hz
        keep = np.exp(-self.lambda_rad_per_s / self.rate_hz)
        return slope, slope * (1 - keep) / (1 - keep * back)


def _largest_common(alpha: Real, beta: Real, gamma: Real) -> float:
    """Largest K with α K² + β K + γ ≤ 0 at every frequency, α ≥ 0; 0 unless K = 0 is passive."""
    if gamma.max() >= 0.0:
        return 0.0
    below = beta + np.sqrt(beta**2 - 4 * alpha * gamma)
    bounded = below > 0.0
    return float(np.min(-2 * gamma[bounded] / below[bounded]))
