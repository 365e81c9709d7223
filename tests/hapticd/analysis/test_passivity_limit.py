"""Passivity of sampled walls against the published formulas and against brute force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hapticd.analysis.passivity_limit import (
    SampledWall,
    abbott_okamura_n_per_m,
    colgate_schenkel_n_per_m,
    spring_drive_is_passive,
)

IDEAL = SampledWall(75.0, 1000.0, delay_s=0.0, lag_s=0.0, lambda_rad_per_s=1e9)


def test_150_newton_per_millimetre_at_1_khz_need_75_newton_seconds() -> None:
    """Physics §6."""
    assert IDEAL.largest_stiffness_n_per_m(0.0) == pytest.approx(150e3, rel=1e-4)
    assert colgate_schenkel_n_per_m(75.0, 0.0, 1000.0) == pytest.approx(150e3)


@pytest.mark.parametrize("damping", [0.0, 10.0, 40.0, -20.0])
def test_without_delay_the_general_form_is_that_of_colgate_and_schenkel(damping: float) -> None:
    expected = colgate_schenkel_n_per_m(75.0, damping, 1000.0)
    assert IDEAL.largest_stiffness_n_per_m(damping) == pytest.approx(expected, rel=0.015)


@pytest.mark.parametrize("ticks", [1, 2, 5])
def test_each_tick_of_delay_needs_b_over_half_a_tick_and_the_delay(ticks: int) -> None:
    late = replace(IDEAL, delay_s=ticks * 1e-3)
    assert late.largest_stiffness_n_per_m(0.0) == pytest.approx(75.0 / (0.5e-3 + ticks * 1e-3), rel=2e-3)


@pytest.mark.parametrize(
    ("wall", "damping"),
    [
        (SampledWall(3.0, 1000.0, 0.3e-3, 0.5e-3, 1256.6), 2.0),
        (SampledWall(3.0, 1000.0, 1.2e-3, 0.0, 1256.6), 1.0),
        (SampledWall(0.013, 1000.0, 1e-3, 2e-3, 1256.6, series_n_per_m=3500.0), 0.0),
    ],
)
def test_the_limit_is_where_the_worst_motion_draws_all_that_friction_takes(
    wall: SampledWall, damping: float
) -> None:
    limit = wall.largest_stiffness_n_per_m(damping)
    assert drawn(wall, limit, damping) == pytest.approx(1.0, abs=0.01)
    assert drawn(wall, 1.05 * limit, damping) > 1.02


def drawn(wall: SampledWall, stiffness: float, damping: float) -> float:
    """Largest share of the friction's loss that the wall gives back, over all motions with their images."""
    period_s = 1.0 / wall.rate_hz
    worst = 0.0
    for angle in np.linspace(0.02, np.pi, 24):
        omega = (angle + 2 * np.pi * np.arange(-40, 41)) / period_s
        lag, back = 1 + 1j * omega * wall.lag_s, np.exp(-1j * angle)
        keep = np.exp(-wall.lambda_rad_per_s * period_s)
        law = stiffness + damping * (1 - keep) / period_s * (1 - back) / (1 - keep * back)
        force = np.exp(-1j * omega * wall.delay_s) / lag / omega * (1 - back) * law / period_s
        form = np.outer(force, 1 / omega)
        friction = wall.friction_n_s_per_m + wall.series_n_per_m * wall.lag_s / np.abs(lag) ** 2
        scaled = (form + form.conj().T) / 2 / np.sqrt(np.outer(friction, friction))
        worst = max(worst, float(np.linalg.eigvalsh(scaled)[-1]))
    return worst


def test_a_device_without_friction_renders_nothing_passively() -> None:
    assert replace(IDEAL, friction_n_s_per_m=0.0).largest_stiffness_n_per_m(0.0) == 0.0


def test_damping_past_the_friction_is_not_passive() -> None:
    assert IDEAL.largest_stiffness_n_per_m(80.0) == 0.0


def test_faster_sampling_brings_the_spring_drive_to_the_spring_of_its_inductance() -> None:
    drive = SampledWall(0.013, 1000.0, 0.0, 2.2e-3, 1256.6, series_n_per_m=3500.0)
    limits = [replace(drive, rate_hz=rate).largest_stiffness_n_per_m(0.0) for rate in (1e3, 4e3, 16e3)]
    assert limits == sorted(limits)
    assert limits[-1] == pytest.approx(3500.0, rel=0.05)


def test_quantisation_limit_of_the_phantom() -> None:
    """Physics §2.2: 0.04 N and 31 µm give 2.6 N/mm."""
    assert abbott_okamura_n_per_m(0.04, 30.7e-6) == pytest.approx(2600.0, rel=0.01)


def test_spring_drive_is_passive_up_to_k_hf() -> None:
    assert spring_drive_is_passive(2.3, 2.3)
    assert not spring_drive_is_passive(2.31, 2.3)
