"""How stiff a wall may be on a spring drive and on a current amplifier, by rate and delay."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.linear_loop import LinearLoop
from hapticd.analysis.passivity_limit import SampledWall, abbott_okamura_n_per_m
from hapticd.analysis.spring_drive import SpringDrive

Vector = NDArray[np.float64]

DAMPINGS = np.geomspace(0.01, 1.6, 32)
"""Shares of m/T at which the damping that lets a current drive be stiffest is looked for."""

COLUMNS = (
    "spring_stable_n_per_m",
    "spring_passive_n_per_m",
    "current_stable_n_per_m",
    "current_undamped_n_per_m",
    "current_passive_n_per_m",
)


@dataclass(frozen=True, slots=True)
class Bench:
    """The tip both drives move, and the spring drive in units of the tip. SI."""

    mass_kg: float
    viscous_n_s_per_m: float
    coulomb_n: float
    quantum_m: float
    lambda_rad_per_s: float
    current_lag_s: float
    series_n_per_m: float
    series_lag_s: float

    def largest(self, rate_hz: float, delay_ticks: int) -> tuple[float, ...]:
        """Largest stiffness of every one of ``COLUMNS`` at a rate with a delay, N/m."""
        delay_s, lam = delay_ticks / rate_hz, self.lambda_rad_per_s
        device = (self.mass_kg, self.viscous_n_s_per_m, rate_hz, delay_s)
        spring = LinearLoop(*device, self.series_lag_s, lam, self.series_n_per_m)
        current = LinearLoop(*device, self.current_lag_s, lam)
        port = (self.viscous_n_s_per_m, rate_hz, delay_s)
        return (
            spring.largest_stiffness_n_per_m(0.0),
            SampledWall(*port, self.series_lag_s, lam, self.series_n_per_m).largest_stiffness_n_per_m(0.0),
            best_damped(current)[0],
            current.largest_stiffness_n_per_m(0.0),
            SampledWall(*port, self.current_lag_s, lam).largest_stiffness_n_per_m(0.0),
        )

    @property
    def by_resolution_n_per_m(self) -> float:
        """2 f_c/Δ: beyond it a count gives more energy than dry friction takes (Abbott & Okamura)."""
        return abbott_okamura_n_per_m(self.coulomb_n, self.quantum_m)


def best_damped(loop: LinearLoop) -> tuple[float, float]:
    """Largest stable stiffness over all dampings, N/m, and the damping that allows it, N·s/m."""
    dampings = DAMPINGS * loop.mass_kg * loop.rate_hz
    stiffness = [loop.largest_stiffness_n_per_m(float(damping)) for damping in dampings]
    best = int(np.argmax(stiffness))
    return float(stiffness[best]), float(dampings[best])


@dataclass(frozen=True)
class Limits:
    """Largest stiffness by rate at one delay; each of ``COLUMNS`` (n,), N/m."""

    delay_ticks: int
    rate_hz: Vector
    columns: Mapping[str, Vector]

    def at(self, rate_hz: float) -> dict[str, float]:
        """The row whose rate is nearest."""
        row = int(np.argmin(np.abs(np.log(self.rate_hz / rate_hz))))
        return {name: float(column[row]) for name, column in self.columns.items()}

    def numbers(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "delay_ticks": self.delay_ticks,
            "rate_hz": self.rate_hz.tolist(),
            **{name: column.tolist() for name, column in self.columns.items()},
        }

    def trace(self) -> dict[str, Vector]:
        """As a table."""
        return {"rate_hz": self.rate_hz, **self.columns}


def tip_drive(drive: SpringDrive, per_rotor: float) -> tuple[float, float]:
    """K_HF at the tip, N/m, and L/dR, s, of a drive that turns ``per_rotor`` radians a metre."""
    return drive.k_hf * per_rotor**2, drive.inductance / drive.d_r
