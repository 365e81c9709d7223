"""The sampled loop against the numbers of physics.md, a simulation by steps, and what must be monotonic."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from hapticd.analysis.linear_loop import LinearLoop

K_T, INDUCTANCE, D_R, TIP = 0.0234, 0.000238, 0.109, 7.0 / 0.14
LAMBDA = 2 * np.pi * 200

SPRING_DRIVE = LinearLoop(
    mass_kg=0.075,
    friction_n_s_per_m=0.1,
    rate_hz=1000.0,
    delay_s=0.0,
    lag_s=INDUCTANCE / D_R,
    lambda_rad_per_s=LAMBDA,
    series_n_per_m=(K_T * TIP) ** 2 / INDUCTANCE,
)
TORQUE_DRIVE = LinearLoop(1.0, 3.0, 1000.0, 1e-3, 5e-4, LAMBDA)


@pytest.mark.parametrize(
    ("rate_hz", "delay_s", "k_p"), [(1000, 0, 8.9), (1000, 1e-3, 6.7), (2000, 0, 9.7), (5000, 0, 10.4)]
)
def test_spring_drive_is_stable_up_to_the_gains_of_the_table(
    rate_hz: float, delay_s: float, k_p: float
) -> None:
    """Physics §2.2: 75 g, 0.1 N·s/m, R̂ = 0.95 R, K_D = 0."""
    loop = replace(SPRING_DRIVE, rate_hz=float(rate_hz), delay_s=delay_s)
    volts_per_rad = loop.largest_stiffness_n_per_m(0.0) * D_R / (K_T * TIP**2)
    assert volts_per_rad == pytest.approx(k_p, abs=0.06)


@pytest.mark.parametrize("mass_kg", [0.75, 2.0])
def test_sampled_damper_is_stable_up_to_1_24_m_over_t(mass_kg: float) -> None:
    """Physics §6: T = 1 ms, 200 Hz filter, 0.5 ms lag."""
    loop = LinearLoop(mass_kg, 3.0, 1000.0, 0.0, 5e-4, LAMBDA)
    assert loop.largest_damping_n_s_per_m() == pytest.approx(1.24 * mass_kg * 1000.0, rel=0.01)


def test_a_spring_without_delay_and_filter_is_stable_up_to_2b_over_t() -> None:
    """Zero-order hold is half a tick of delay: for a heavy tip K = b/(T/2)."""
    loop = LinearLoop(50.0, 2.0, 1000.0, 0.0, 0.0, LAMBDA)
    assert loop.largest_stiffness_n_per_m(0.0) == pytest.approx(2 * 2.0 * 1000.0, rel=0.01)


@pytest.mark.parametrize("delay_s", [0.0, 0.4e-3, 1e-3, 1.7e-3])
@pytest.mark.parametrize("share", [0.97, 1.03])
def test_limit_divides_decay_from_growth_in_a_simulation(delay_s: float, share: float) -> None:
    loop = replace(TORQUE_DRIVE, delay_s=delay_s)
    stiffness = share * loop.largest_stiffness_n_per_m(100.0)
    early, late = envelope(loop, stiffness, 100.0)
    assert (late < early) == (share < 1.0)


def envelope(loop: LinearLoop, stiffness: float, damping: float) -> tuple[float, float]:
    """Largest excursion in two parts of a fine-stepped simulation that shares nothing with the analysis."""
    steps, ticks = 200, 1500
    h = 1.0 / loop.rate_hz / steps
    x, v, f, before, estimate = 1e-3, 0.0, 0.0, 1e-3, 0.0
    keep = np.exp(-loop.lambda_rad_per_s / loop.rate_hz)
    late = round(loop.delay_s / h)
    waiting = [0.0] * (late // steps + 2)
    path = []
    for _ in range(ticks):
        estimate = keep * estimate + (1 - keep) * (x - before) * loop.rate_hz
        before = x
        waiting = [-stiffness * x - damping * estimate, *waiting[:-1]]
        for step in range(steps):
            age = late // steps + (1 if step < late % steps else 0)
            f += h / loop.lag_s * (waiting[age] - f)
            v += h * (f - loop.friction_n_s_per_m * v) / loop.mass_kg
            x += h * v
        path.append(abs(x))
    return max(path[300:700]), max(path[-400:])


@pytest.mark.parametrize("worse", [{"delay_s": 2e-3}, {"lag_s": 1e-3}, {"friction_n_s_per_m": 1.0}])
def test_delay_lag_and_missing_friction_lower_the_limit(worse: dict[str, float]) -> None:
    usual = TORQUE_DRIVE.largest_stiffness_n_per_m(50.0)
    assert replace(TORQUE_DRIVE, **worse).largest_stiffness_n_per_m(50.0) < usual


def test_the_limit_falls_steadily_with_fractional_delay() -> None:
    limits = [
        replace(TORQUE_DRIVE, delay_s=d).largest_stiffness_n_per_m(100.0) for d in np.linspace(0, 3e-3, 13)
    ]
    assert all(later < earlier for earlier, later in pairwise(limits))


def test_a_massless_tip_is_never_stable() -> None:
    loop = replace(TORQUE_DRIVE, mass_kg=0.0)
    assert loop.largest_stiffness_n_per_m(10.0) == 0.0
    assert loop.largest_damping_n_s_per_m() == 0.0


def test_too_much_damping_leaves_no_stable_spring() -> None:
    assert TORQUE_DRIVE.largest_stiffness_n_per_m(1.05 * TORQUE_DRIVE.largest_damping_n_s_per_m()) == 0.0
