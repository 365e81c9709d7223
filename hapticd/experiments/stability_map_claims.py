"""What theory says about where a wall is stable, and whether the twin agrees."""

from __future__ import annotations

import math

import numpy as np

from hapticd.analysis.linear_loop import LinearLoop
from hapticd.analysis.passivity_limit import SampledWall
from hapticd.experiments.claims import judged
from hapticd.experiments.experiment import Claim
from hapticd.experiments.stability_lines import Lines, lines
from hapticd.experiments.stability_survey import Survey

RATE_HZ = 1000.0
LAMBDA_RAD_PER_S = 2 * math.pi * 200.0
LAG_S = 5e-4
WALL_N_PER_M = 150e3
"""KS' wall, and what physics §6 takes for its loop."""


def claims(survey: Survey, found: Lines, slippery: Survey | None, *, watched: bool) -> tuple[Claim, ...]:
    """The claims of physics §2.2 and §6 that a map decides.

    ``slippery`` is the hhd's second look, ``watched`` whether passivity watched the wall.
    """
    general = [_passive(survey, found), _linear(survey, found)]
    if watched:
        general.append(_passivity(survey))
    if survey.sheet.loop_at(*survey.sheet.points()[0]).coupling.is_spring_drive:
        return (*general, _delay_costs_the_spring_drive())
    if slippery is not None:
        general.append(_dry_friction(found, slippery))
    return (*general, _needed_friction(), _damping_limit())


def _passivity(survey: Survey) -> Claim:
    settled = int(survey.settled().sum())
    return judged(
        "Passivity control makes walls stable that are not stable by themselves",
        "KS §3",
        "every wall of the map settles under a gentle push",
        f"{settled} of {survey.outcome.size}",
        holds=settled == survey.outcome.size,
    )


def _passive(survey: Survey, found: Lines) -> Claim:
    settled, points = found.below(survey, found.passive)
    looked_at = found.passive > 0.0
    ratio = float(np.max(found.settled_up[looked_at] / found.passive[looked_at], initial=0.0))
    return judged(
        "The limit of passivity is conservative: every wall below it settles",
        "physics §6, Colgate & Schenkel",
        "all points below the line settle, others above it too",
        f"{settled} of {points} below; up to {ratio:.3g} times the limit settles",
        holds=settled == points and ratio > 1.0,
    )


def _linear(survey: Survey, found: Lines) -> Claim:
    settled, points = found.below(survey, found.linear)
    return judged(
        "Hand and dry friction only help: every wall that is stable linearly settles",
        "physics §6",
        "all points below the line of the linear loop settle",
        f"{settled} of {points}",
        holds=settled == points,
    )


def _dry_friction(found: Lines, slippery: Survey) -> Claim:
    usual, less = float(found.settled_up[0]), float(lines(slippery).settled_up[0])
    return judged(
        "Dry friction holds an undamped wall: it settles where 4 f_c A exceeds what delay gives",
        "physics §6, §9 (d)",
        "with a tenth of the dry friction the largest stiffness that settles falls by more than a third",
        f"{usual:.3g} N/m, with a tenth {less:.3g} N/m",
        holds=less < 2 / 3 * usual,
    )


def _needed_friction() -> Claim:
    """By bisection over friction with the general form, not by the formula it is compared with."""
    low, high = 1.0, 1000.0
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        wall = SampledWall(middle, RATE_HZ, 0.0, 0.0, LAMBDA_RAD_PER_S)
        low, high = (low, middle) if wall.largest_stiffness_n_per_m(0.0) >= WALL_N_PER_M else (middle, high)
    return judged(
        "150 N/mm at 1 kHz is passive from b = 75 N·s/m on",
        "physics §6, Colgate & Schenkel",
        "75 N·s/m, without delay",
        f"{high:.2f} N·s/m",
        holds=abs(high - 75.0) < 0.5,
    )


def _damping_limit() -> Claim:
    found = [
        LinearLoop(mass, 3.0, RATE_HZ, 0.0, LAG_S, LAMBDA_RAD_PER_S).largest_damping_n_s_per_m()
        / (mass * RATE_HZ)
        for mass in (0.75, 2.0)
    ]
    return judged(
        "A sampled damper is stable up to 1.24 m/T (T = 1 ms, 200 Hz filter, 0.5 ms lag)",
        "physics §6",
        "1.24 m/T at 0.75 kg and at 2 kg, without delay",
        ", ".join(f"{value:.3f}" for value in found),
        holds=all(abs(value - 1.24) < 0.02 for value in found),
    )


def _delay_costs_the_spring_drive() -> Claim:
    """The single joint of physics §2.2: 75 g, 0.1 N·s/m, R̂ = 0.95 R, tip factor (ρ/l)² = 2500 m⁻²."""
    k_t, inductance, d_r, tip = 0.0234, 0.000238, 0.109, 7.0 / 0.14
    found = []
    for delay_s in (0.0, 1e-3):
        loop = LinearLoop(
            mass_kg=0.075,
            friction_n_s_per_m=0.1,
            rate_hz=RATE_HZ,
            delay_s=delay_s,
            lag_s=inductance / d_r,
            lambda_rad_per_s=LAMBDA_RAD_PER_S,
            series_n_per_m=(k_t * tip) ** 2 / inductance,
        )
        found.append(loop.largest_stiffness_n_per_m(0.0) * d_r / (k_t * tip**2))
    return judged(
        "The spring drive is stable up to K_P = 8.9 V/rad at 1 ms, 6.7 V/rad with a sample of delay",
        "physics §2.2",
        "8.9 and 6.7 V/rad",
        f"{found[0]:.2f} and {found[1]:.2f} V/rad",
        holds=abs(found[0] - 8.9) < 0.1 and abs(found[1] - 6.7) < 0.1,
    )
