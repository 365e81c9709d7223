"""Force of a held tip by the motion of its set-point over frequency, in closed form."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.spring_drive import Spectrum, SpringDrive
from hapticd.model import Model

Vector = NDArray[np.float64]

COPPER_PER_K = 0.00393
REFERENCE_C = 25.0
"""R(T) = R₂₅ (1 + 0.00393 (T − 25 °C)), as in the core's thermal model."""


class RenderedStiffness(Protocol):
    """Stiffness at the tip, N/m, complex over frequency."""

    def continuous(self, frequency_hz: Vector) -> Spectrum:
        """As the paper has it, without a servo's ticks."""
        ...

    def sampled(self, frequency_hz: Vector, period_s: float, delay_ticks: int) -> Spectrum:
        """With a command that is computed every ``period_s``, held between, and late."""
        ...

    def commanded(self, frequency_hz: Vector) -> Spectrum:
        """What is asked of the motors, before their lag."""
        ...


@dataclass(frozen=True, slots=True)
class SpringDrives:
    """Transpose mapping onto spring drives: joint i carries ``shares[i]`` of k_c (WN eq. 23–26)."""

    k_c: float
    drives: tuple[SpringDrive, ...]
    shares: Vector

    @classmethod
    def at(cls, model: Model, k_c: float, q: Vector, direction: Vector, winding_c: Vector) -> SpringDrives:
        """At joint angles ``q``, (3,) rad, along the unit vector ``direction``, windings at ``winding_c`` °C.

        F·d = dᵀ J⁻ᵀ H Jᵀ d k_c, H diagonal with the joints' own frequency responses, 1 at rest.
        """
        jacobian = np.array(_core.Kinematics(model.device_json).jacobian(q))
        shares = np.linalg.solve(jacobian, direction) * (jacobian.T @ direction)
        return cls(k_c, tuple(_warm(model, axis, float(winding_c[axis])) for axis in range(3)), shares)

    def continuous(self, frequency_hz: Vector) -> Spectrum:
        """k_c K_θ(jω)/K_DC (WN eq. 12)."""
        return self._mixed([drive.stiffness(frequency_hz) for drive in self.drives])

    def sampled(self, frequency_hz: Vector, period_s: float, delay_ticks: int) -> Spectrum:
        """Exact at the sampling instants."""
        return self._mixed(
            [drive.sampled_setpoint(frequency_hz, period_s, delay_ticks) for drive in self.drives]
        )

    def commanded(self, frequency_hz: Vector) -> Spectrum:
        """k_c (K_P + (k_T + K_D) jω)/K_P."""
        s = 2j * np.pi * frequency_hz
        joints = [drive.k_dc * (1 + s * (drive.k_t + drive.k_d) / drive.k_p) for drive in self.drives]
        return self._mixed([np.asarray(joint, dtype=np.complex128) for joint in joints])

    def _mixed(self, joints: Sequence[Spectrum]) -> Spectrum:
        parts = [
            share * joint / drive.k_dc
            for share, joint, drive in zip(self.shares, joints, self.drives, strict=True)
        ]
        found: Spectrum = self.k_c * np.sum(parts, axis=0)
        return found


def _warm(model: Model, axis: int, winding_c: float) -> SpringDrive:
    """The drive with a winding of ``winding_c``; a cold one gets less gain, never a stiffer joint."""
    tuned = SpringDrive.of_model(model, axis)
    warm = replace(tuned, r=tuned.r * (1 + COPPER_PER_K * (winding_c - REFERENCE_C)))
    gain = min(1.0, warm.d_r / tuned.d_r)
    return replace(warm, k_p=gain * tuned.k_p, k_d=gain * tuned.k_d)


@dataclass(frozen=True, slots=True)
class VirtualCoupling:
    """k + jωb in front of motors with a lag: stiffness N/m, damping N·s/m, lag s."""

    k: float
    b: float
    lag_s: float

    @classmethod
    def of_model(cls, model: Model) -> VirtualCoupling:
        """The coupling of a device model with torque drives."""
        drive = json.loads(model.device_json)["drive"]
        return cls(drive["stiffness_n_per_m"], drive["damping_n_s_per_m"], drive["lag_s"])

    def continuous(self, frequency_hz: Vector) -> Spectrum:
        """(k + jωb)/(1 + jω lag)."""
        found: Spectrum = self.commanded(frequency_hz) / (1 + 2j * np.pi * frequency_hz * self.lag_s)
        return found

    def sampled(self, frequency_hz: Vector, period_s: float, delay_ticks: int) -> Spectrum:
        """Held over each tick and late; the torque keeps a = e^(−T/lag) of itself."""
        z = np.exp(2j * np.pi * frequency_hz * period_s)
        a = np.exp(-period_s / self.lag_s) if self.lag_s > 0.0 else 0.0
        found: Spectrum = self.commanded(frequency_hz) * (1 - a) / (z - a) * z**-delay_ticks
        return found

    def commanded(self, frequency_hz: Vector) -> Spectrum:
        """k + jωb."""
        return np.asarray(self.k + 2j * np.pi * frequency_hz * self.b, dtype=np.complex128)
