"""One spring drive with its drift compensation, seen from its rotor (WN §II, §III)."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.model import Model

Spectrum = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class SpringDrive:
    """k_T N·m/A, R and R̂ Ω, L H, K_P V/rad, K_D V·s/rad, λ rad/s. Stiffness is torque against the angle."""

    k_t: float
    r: float
    r_hat: float
    inductance: float
    k_p: float
    k_d: float
    lam: float

    @classmethod
    def of_model(cls, model: Model, axis: int) -> SpringDrive:
        """The drive of one motor of a device model with spring drives."""
        device: dict[str, Any] = json.loads(model.device_json)
        drive = device["drive"]
        return cls(
            k_t=drive["k_t_nm_per_a"][axis],
            r=drive["r_25_ohm"][axis],
            r_hat=drive["r_hat_ohm"][axis],
            inductance=drive["l_h"][axis],
            k_p=drive["k_p_v_per_rad"][axis],
            k_d=drive["k_d_v_s_per_rad"][axis],
            lam=device["estimator"]["lambda_rad_per_s"],
        )

    @property
    def d_r(self) -> float:
        """dR = R − R̂, Ω (WN eq. 7)."""
        return self.r - self.r_hat

    @property
    def k_dc(self) -> float:
        """K_DC = k_T K_P/dR, N·m/rad (WN eq. 13)."""
        return self.k_t * self.k_p / self.d_r

    @property
    def k_hf(self) -> float:
        """K_HF = K_L = k_T²/L, N·m/rad (WN eq. 14)."""
        return self.k_t**2 / self.inductance

    @property
    def b_dr(self) -> float:
        """B_dR = k_T²/dR, N·m·s/rad: the damper that is left in series (WN eq. 8)."""
        return self.k_t**2 / self.d_r

    @property
    def corner_hz(self) -> float:
        """dR/L, Hz: where the uncompensated drive turns from damper to spring (WN §III)."""
        return self.d_r / self.inductance / (2 * np.pi)

    @property
    def k_p_flat(self) -> float:
        """K_P = k_T dR/L, V/rad: with K_D = 0 the stiffness is k_T²/L at every frequency."""
        return self.k_t * self.d_r / self.inductance

    @property
    def passivity_margin(self) -> float:
        """1 − (K_P + λ K_D) L/(k_T dR): the continuous coupling is passive exactly when it is not negative.

        Im K_θ(jω) ≥ 0 at every ω is k_T dR + K_D (dR λ² − L λ ω²)/(λ² + ω²) ≥ L K_P; its left side falls
        with ω.
        """
        return 1 - (self.k_p + self.lam * self.k_d) / self.k_p_flat

    @property
    def added_inertia(self) -> float:
        """k_T²/(dR λ), kg·m²: what free space costs with a filtered set-point velocity."""
        return self.k_t**2 / (self.d_r * self.lam)

    def unmodified(self) -> SpringDrive:
        """The bare motor: nothing cancelled, no compensation."""
        return replace(self, r_hat=0.0, k_p=0.0, k_d=0.0)

    def compensated(self, k_p: float, k_d: float) -> SpringDrive:
        """The same amplifier with other error gains."""
        return replace(self, k_p=k_p, k_d=k_d)

    def stiffness(self, frequency_hz: NDArray[np.float64]) -> Spectrum:
        """Torque that resists, by angle, against a resting set-point: WN eq. 12 without its sign, N·m/rad."""
        s = 2j * np.pi * frequency_hz
        feedback = self.k_p + self.k_d * s * self.lam / (s + self.lam)
        found: Spectrum = self.k_t * (self.k_t * s + feedback) / (self.inductance * s + self.d_r)
        return found

    def printed(self, frequency_hz: NDArray[np.float64]) -> Spectrum:
        """τ/θ as WN eq. 12 has it, sign included, N·m/rad."""
        s = 2j * np.pi * frequency_hz
        bracket = (self.k_t + self.k_d + self.k_p / self.lam) * s + self.k_p + self.k_t * s**2 / self.lam
        found: Spectrum = -self.k_t / (self.inductance * s + self.d_r) * self.lam / (s + self.lam) * bracket
        return found

    def sampled(self, frequency_hz: NDArray[np.float64], period_s: float, delay_ticks: int) -> Spectrum:
        """As ``stiffness``, with feedback that is computed every ``period_s``, held between, and late.

        Exact at the sampling instants.
        """
        found: Spectrum = self._back_emf(frequency_hz) + self.sampled_feedback(
            frequency_hz, period_s, delay_ticks
        )
        return found

    def sampled_feedback(
        self, frequency_hz: NDArray[np.float64], period_s: float, delay_ticks: int
    ) -> Spectrum:
        """The part of ``sampled`` that the feedback adds to what the winding does by itself."""
        z = np.exp(2j * np.pi * frequency_hz * period_s)
        feedback = self.k_p + self.k_d * self._sampled_velocity(z, period_s)
        found: Spectrum = self._held(z, period_s) * z**-delay_ticks * feedback
        return found

    def sampled_setpoint(
        self, frequency_hz: NDArray[np.float64], period_s: float, delay_ticks: int
    ) -> Spectrum:
        """Torque by set-point with the rotor held, the set-point's velocity known exactly, N·m/rad.

        WN eq. 10 and 11 computed every ``period_s``, held between, and late; exact at the sampling instants.
        Without hold and delay, and with K_D = 0 or λ → ∞, it is ``stiffness``.
        """
        z = np.exp(2j * np.pi * frequency_hz * period_s)
        feed = self.k_p + (self.k_t + self.k_d) * 2j * np.pi * frequency_hz
        found: Spectrum = self._held(z, period_s) * z**-delay_ticks * feed
        return found

    def free_space(self, frequency_hz: NDArray[np.float64]) -> Spectrum:
        """As ``stiffness`` with the set-point on the rotor (WN eq. 16): what the filter's lag leaves."""
        s = 2j * np.pi * frequency_hz
        found: Spectrum = self._back_emf(frequency_hz) * s / (s + self.lam)
        return found

    def sampled_free_space(
        self, frequency_hz: NDArray[np.float64], period_s: float, delay_ticks: int
    ) -> Spectrum:
        """As ``free_space``, with a set-point velocity that is computed every ``period_s``, held and late."""
        z = np.exp(2j * np.pi * frequency_hz * period_s)
        setpoint = self.k_t * self._sampled_velocity(z, period_s)
        held = self._held(z, period_s) * z**-delay_ticks
        found: Spectrum = self._back_emf(frequency_hz) - held * setpoint
        return found

    def _back_emf(self, frequency_hz: NDArray[np.float64]) -> Spectrum:
        """k_T² s/(L s + dR): what the winding does by itself."""
        s = 2j * np.pi * frequency_hz
        found: Spectrum = self.k_t**2 * s / (self.inductance * s + self.d_r)
        return found

    def _held(self, z: Spectrum, period_s: float) -> Spectrum:
        """Torque per volt that is held over a tick, N·m/V; the current keeps a = e^(−T dR/L) of itself."""
        a = np.exp(-self.d_r / self.inductance * period_s)
        found: Spectrum = self.k_t / self.d_r * (1 - a) / (z - a)
        return found

    def _sampled_velocity(self, z: Spectrum, period_s: float) -> Spectrum:
        """Filtered difference quotient of the angle, 1/s."""
        keep = np.exp(-self.lam * period_s)
        found: Spectrum = (1 - keep) / period_s * (1 - 1 / z) / (1 - keep / z)
        return found
