"""The sampled closed loop at a wall, linear: no contact, no dry friction, no resolution, no operator."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.bisection import largest
from hapticd.analysis.matrix_exponential import exponential

Matrix = NDArray[np.float64]

STIFFNESS_RANGE_N_PER_M = (1.0, 1e8)
DAMPING_RANGE_N_S_PER_M = (1e-3, 1e6)
ACCURACY = 1e-3
"""Of a largest gain, relative."""

WHOLE = 1e-9
"""Share of a tick by which a delay may miss a whole number of ticks."""


@dataclass(frozen=True, slots=True)
class LinearLoop:
    """A mass m with friction b behind an actuator, under F = −K x − B v̂ sampled at 1/T and held.

    The actuator is τ_a ḟ = u − f − τ_a K_s v. With K_s = 0 that is a torque drive with a lag; with
    τ_a = L/dR and K_s = K_HF it is the spring drive (WN §III) under e_W = −K_P θ, K = K_DC. The velocity v̂
    is the estimator's: differences through λ/(s+λ).

    ``delay_s`` runs from the latch of the encoders to the change of the actuators' command.
    """

    mass_kg: float
    friction_n_s_per_m: float
    rate_hz: float
    delay_s: float
    lag_s: float
    lambda_rad_per_s: float
    series_n_per_m: float = 0.0

    def largest_eigenvalue(self, stiffness_n_per_m: float, damping_n_s_per_m: float) -> float:
        """|z| of the slowest mode with K and B; below 1 the loop is stable."""
        step, held, position, velocity = _matrices(self)
        feedback = -stiffness_n_per_m * position - damping_n_s_per_m * velocity
        return float(np.abs(np.linalg.eigvals(step + np.outer(held, feedback))).max())

    def largest_stiffness_n_per_m(self, damping_n_s_per_m: float) -> float:
        """Largest stable K with this B, N/m; 0 when none is."""

        def stable(stiffness_n_per_m: float) -> bool:
            return self.largest_eigenvalue(stiffness_n_per_m, damping_n_s_per_m) < 1.0

        return largest(stable, *STIFFNESS_RANGE_N_PER_M, ACCURACY) if self.mass_kg > 0.0 else 0.0

    def largest_damping_n_s_per_m(self) -> float:
        """Largest stable B of a wall without a spring, N·s/m; 0 when none is."""
        weakest = STIFFNESS_RANGE_N_PER_M[0]  # without any spring the place itself is a mode with |z| = 1

        def stable(damping_n_s_per_m: float) -> bool:
            return self.largest_eigenvalue(weakest, damping_n_s_per_m) < 1.0

        return largest(stable, *DAMPING_RANGE_N_S_PER_M, ACCURACY) if self.mass_kg > 0.0 else 0.0


@lru_cache(maxsize=256)
def _matrices(loop: LinearLoop) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Step and input of the state (plant, last x, last v̂, commands on their way), and the rows of x and v̂."""
    plant, force = _plant(loop)
    order, period_s = len(plant), 1.0 / loop.rate_hz
    ticks, rest = _split(loop.delay_s * loop.rate_hz)
    early, late = rest * period_s, (1.0 - rest) * period_s
    waiting = ticks + (1 if rest > 0.0 else 0)
    size = order + 2 + waiting
    position, velocity = _estimate(loop, size, order)

    step, held = np.zeros((size, size)), np.zeros(size)
    step[:order, :order] = exponential(plant * period_s)
    step[order, 0] = 1.0
    step[order + 1] = velocity
    commands = np.eye(size)[order + 2 :]  # rows: the command one tick old, two ticks old, …
    for age, effect in (
        (ticks, _impulse(plant, force, late)),
        (ticks + 1, exponential(plant * late) @ _impulse(plant, force, early)),
    ):
        if age == 0:
            held[:order] += effect
        elif age <= waiting:
            step[:order] += np.outer(effect, commands[age - 1])
    if waiting:
        held[order + 2] = 1.0
        step[order + 3 :, order + 2 : -1] = np.eye(waiting - 1)
    return step, held, position, velocity


def _plant(loop: LinearLoop) -> tuple[Matrix, Matrix]:
    """Continuous x, v and actuator force, and how the command enters."""
    m, b, tau = loop.mass_kg, loop.friction_n_s_per_m, loop.lag_s
    if tau == 0.0:
        return np.array([[0.0, 1.0], [0.0, -b / m]]), np.array([0.0, 1.0 / m])
    plant = [[0.0, 1.0, 0.0], [0.0, -b / m, 1.0 / m], [0.0, -loop.series_n_per_m, -1.0 / tau]]
    return np.array(plant), np.array([0.0, 0.0, 1.0 / tau])


def _split(delay_ticks: float) -> tuple[int, float]:
    """Whole ticks of a delay, and the share of a tick that is left."""
    ticks = math.floor(delay_ticks + WHOLE)
    rest = delay_ticks - ticks
    return ticks, rest if rest > WHOLE else 0.0


def _estimate(loop: LinearLoop, size: int, order: int) -> tuple[Matrix, Matrix]:
    """Rows that read x and v̂ from the state."""
    position, velocity = np.zeros(size), np.zeros(size)
    keep = math.exp(-loop.lambda_rad_per_s / loop.rate_hz)
    slope = (1.0 - keep) * loop.rate_hz
    position[0] = 1.0
    velocity[[0, order, order + 1]] = slope, -slope, keep
    return position, velocity


def _impulse(plant: Matrix, force: Matrix, duration_s: float) -> Matrix:
    """State after a unit command held for ``duration_s``: ∫ e^(At) b dt (van Loan)."""
    order = len(plant)
    block = np.zeros((order + 1, order + 1))
    block[:order, :order], block[:order, order] = plant, force
    return exponential(block * duration_s)[:order, order]
