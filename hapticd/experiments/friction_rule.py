"""KS's rule for friction by motors as printed, beside the one used here, when a moving tip is let go."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hapticd._core import Friction
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]

RULES = ("printed", "corrected")
SUBSTEPS = 20
LET_GO_S = 0.3
WATCH_S = 1.5
PULL_N_S_PER_M = 400.0
"""The hand leads the tip like a damper: firmly, at a steady speed."""

OWN_FRICTION_N = 0.5
"""The tip's own dry friction: a good mechanism's."""

Rule = Callable[[float, float, float], float]


@dataclass(frozen=True)
class Coast:
    """A tip led along the wall and let go."""

    time_s: Vector
    x_m: Vector
    speed_m_per_s: Vector
    force_n: Vector

    @property
    def coast_m(self) -> float:
        """Way after the hand has let go."""
        return float(self.x_m[-1] - self.x_m[np.argmax(self.time_s >= LET_GO_S)])

    @property
    def force_after_n(self) -> float:
        """Largest friction force in the first 20 ms after the hand has let go, less the first two."""
        after = (self.time_s > LET_GO_S + 0.002) & (self.time_s < LET_GO_S + 0.02)
        return float(np.abs(self.force_n[after]).max())

    def numbers(self) -> dict[str, float]:
        """What goes into the results."""
        return {"coast_m": self.coast_m, "force_after_n": self.force_after_n}

    def trace(self) -> dict[str, Vector]:
        """Columns over time."""
        return {
            "time_s": self.time_s,
            "x_m": self.x_m,
            "speed_m_per_s": self.speed_m_per_s,
            "force_n": self.force_n,
        }


def let_go(run: Run, rule: str) -> Coast:
    """Leads the tip at a steady speed, pressed on the wall, and lets go of it sideways alone."""
    force = printed(run) if rule == "printed" else corrected(run)
    period_s, mass_kg = 1.0 / run.number("rate_hz"), run.number("mass_kg")
    ticks = round(WATCH_S / period_s)
    rows = np.zeros((ticks, 3))
    x = v = hand_n = 0.0
    for tick in range(ticks):
        friction_n = force(x, v, hand_n)
        rows[tick] = x, v, friction_n
        for _ in range(SUBSTEPS):
            leads = tick * period_s < LET_GO_S
            hand_n = PULL_N_S_PER_M * (run.number("coast_m_per_s") - v) if leads else 0.0
            x, v = slid(x, v, friction_n + hand_n, mass_kg, period_s / SUBSTEPS)
    return Coast(np.arange(ticks, dtype=np.float64) * period_s, rows[:, 0], rows[:, 1], rows[:, 2])


def slid(x: float, v: float, force_n: float, mass_kg: float, h: float) -> tuple[float, float]:
    """The tip one step on; its own dry friction is implicit, so that it stops and stays."""
    free = v + force_n / mass_kg * h
    kept = float(np.sign(free)) * max(abs(free) - OWN_FRICTION_N / mass_kg * h, 0.0)
    return x + kept * h, kept


def printed(run: Run) -> Rule:
    """F_f = min(μ N, |F_hx|) against F_hx (KS §5)."""
    limit_n = run.number("kinetic") * run.number("weak_push_n")

    def force(_x: float, _v: float, hand_n: float) -> float:
        return -float(np.sign(hand_n)) * min(limit_n, abs(hand_n))

    return force


def corrected(run: Run) -> Rule:
    """The core's: stick by an anchor up to μ_s N, slip at μ_k N whatever the hand pulls."""
    model = run.model("hhd")
    core = Friction(model.device_json, 1.0 / run.number("rate_hz"))
    home = json.loads(model.device_json)["joints"]["home_rad"]
    static = max(run.number("static"), run.number("kinetic"))
    push_n = run.number("weak_push_n")
    wall = (1, [0.0, 1.0, 0.0], push_n, static, run.number("kinetic"), "motor")

    def force(x: float, v: float, hand_n: float) -> float:
        hand = [hand_n, -push_n, 0.0]
        motor_n, _, _ = core.force([wall], q=home, x=[x, 0.0, 0.0], xd=[v, 0.0, 0.0], hand_force_n=hand)
        return motor_n[0]

    return force
