"""How the hand comes to the wall: a push in weak contact, a strike in strong (physics §8)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from hapticd.experiments.run import Run
from hapticd.twin import TwinRun

MODEL = "hhd"

TRIALS = 5
"""Strikes into the air after which the speed where the wall will stand is right to a percent."""

FIRST_S = 0.28
FLIGHT_S = 2.0


def approach(run: Run, strength: str) -> dict[str, Any]:
    """The hand's script. A weak push goes on; a strike ends where the arm holds the steady push."""
    if strength == "weak":
        return {
            "type": "push",
            "direction": [0.0, 1.0, 0.0],
            "force_n": run.number("weak_push_n"),
            "speed_m_per_s": run.number("weak_speed_m_per_s"),
        }
    duration_s, wanted = FIRST_S, run.number("strong_speed_m_per_s")
    for _ in range(TRIALS):
        duration_s *= _speed_at_the_wall(run, duration_s) / wanted
    return strike(run, duration_s)


def strike(run: Run, duration_s: float) -> dict[str, Any]:
    """A minimum-jerk stroke from the start to F/k_a behind the wall."""
    arm_n_per_m = json.loads(run.model(MODEL).twin_json)["hand"]["arm_stiffness_n_per_m"]
    behind_m = run.number("strong_push_n") / arm_n_per_m
    return {
        "type": "minimum_jerk",
        "from_m": [0.0, run.number("start_y_m"), 0.0],
        "to_m": [0.0, run.number("wall_y_m") + behind_m, 0.0],
        "duration_s": duration_s,
    }


def ready(run: Run, walls: list[Mapping[str, Any]]) -> TwinRun:
    """A twin that is enabled among ``walls``, its hand at the start."""
    twin = run.twin(MODEL, rate_hz=run.number("rate_hz"))
    twin.hand({"type": "follow", "target_m": [0.0, run.number("start_y_m"), 0.0]})
    twin.run(1.5)
    twin.scene({"walls": walls})
    twin.enable()
    twin.run(0.5)
    return twin


def _speed_at_the_wall(run: Run, duration_s: float) -> float:
    """Speed of a strike into the air where the wall will stand, m/s. ``ValueError``: too short."""
    twin = ready(run, [])
    twin.hand(strike(run, duration_s))
    records = twin.run(FLIGHT_S + duration_s)
    passed = records["tip_position_m"][:, 1] > run.number("wall_y_m")
    if not passed.any():
        raise ValueError("The strike does not reach the wall: push harder or start nearer.")
    return float(records["tip_velocity_m_per_s"][np.argmax(passed), 1])
