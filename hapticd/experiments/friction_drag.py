"""One hand rubbing along a wall: forces, way, and who does work on whom."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.run import Run
from hapticd.flat_wall import flat_plane

Vector = NDArray[np.float64]

MODEL = "hhd"
STRENGTHS = ("weak", "strong")
SYSTEMS = {"active": "motor", "hybrid": "brake"}
"""What renders the friction; the normal force is always the motors' (KS §5)."""

STIFFNESSES_N_PER_M = (20e3, 30e3, 40e3, 50e3, 60e3, 80e3, 100e3)
RIGID = {"type": "motion", "eta": 0.0}

SETTLE_S = 0.5
REST_S = 0.3
MOVING_M_PER_S = 0.03
AT_REST_M = 5e-5
SLIP = 2


@dataclass(frozen=True)
class Drag:
    """Records from the moment the hand sets out along the wall until it rests again."""

    records: NDArray[Any]
    rate_hz: float
    kinetic: float

    @property
    def time_s(self) -> Vector:
        """Time since the hand set out."""
        return np.arange(len(self.records)) / self.rate_hz

    @property
    def pull_n(self) -> Vector:
        """Measured force of the hand along the wall."""
        return np.asarray(self.records["sensor_force_n"][:, 0])

    @property
    def normal_n(self) -> Vector:
        """Measured force of the hand against the wall."""
        return np.asarray(-self.records["sensor_force_n"][:, 1])

    @property
    def x_m(self) -> Vector:
        """Tip along the wall."""
        return np.asarray(self.records["tip_position_m"][:, 0])

    @property
    def computed_n(self) -> Vector:
        """Friction that is asked for, against the motion."""
        return np.asarray(-self.records["friction_force_n"][:, 0])

    @property
    def break_away(self) -> int:
        """The tick in which the tip begins to slip for good: the last before it moves fast."""
        fast = int(np.argmax(self.records["tip_velocity_m_per_s"][:, 0] > MOVING_M_PER_S))
        stuck = self.records["friction_state"][:fast] != SLIP
        return int(np.flatnonzero(stuck)[-1]) + 1 if stuck.any() else 0

    @property
    def sliding(self) -> NDArray[np.bool_]:
        """Ticks of steady slip: from 0.2 s after the break-away on, while the tip moves."""
        moves = self.records["tip_velocity_m_per_s"][:, 0] > MOVING_M_PER_S
        late = self.time_s > self.time_s[self.break_away] + 0.2
        return np.asarray(moves & late & (self.records["friction_state"] == SLIP))

    @property
    def static_peak_n(self) -> float:
        """Largest pull around the break-away."""
        around = slice(max(self.break_away - self.ticks(0.05), 0), self.break_away + self.ticks(0.1))
        return float(self.pull_n[around].max())

    @property
    def kinetic_n(self) -> float:
        """Median pull in steady slip."""
        return float(np.median(self.pull_n[self.sliding])) if self.sliding.any() else float("nan")

    @property
    def computed_kinetic_n(self) -> float:
        """Median of μ_k times the measured normal force in steady slip."""
        return (
            float(np.median(self.kinetic * self.normal_n[self.sliding]))
            if self.sliding.any()
            else float("nan")
        )

    @property
    def friction_error_n(self) -> float:
        """Measured friction less the computed one, in steady slip."""
        return self.kinetic_n - self.computed_kinetic_n

    @property
    def creep_m(self) -> float:
        """Way of the tip before it breaks away."""
        return float(self.x_m[self.break_away] - self.x_m[0])

    @property
    def swing_m(self) -> float:
        """Peak to peak of the tip, both ways, over the last of the rest."""
        last = self.records["tip_position_m"][-self.ticks(REST_S) :, :2]
        return float(np.ptp(last, axis=0).max())

    @property
    def stable(self) -> bool:
        """Whether the tip came to rest and nothing tripped."""
        return self.swing_m < AT_REST_M and int(self.records["faults"][-1]) == 0

    @property
    def active_work_j(self) -> float:
        """Work of motors and brakes together on the tip along the wall while they push it the way it goes."""
        force_n = self.records["tip_force_n"][:-1, 0]
        return float(np.maximum(force_n * np.diff(self.x_m), 0.0).sum())

    @property
    def hand_work_j(self) -> float:
        """Work that the hand does on the tip along the wall."""
        return float((self.records["hand_force_n"][:-1, 0] * np.diff(self.x_m)).sum())

    @property
    def work_on_hand_j(self) -> float:
        """Work that the tip does on the hand along the wall while it pushes the hand along."""
        force_n = self.records["hand_force_n"][:-1, 0]
        return float(np.maximum(-force_n * np.diff(self.x_m), 0.0).sum())

    def ticks(self, duration_s: float) -> int:
        """Ticks in a while."""
        return round(duration_s * self.rate_hz)

    def numbers(self) -> dict[str, Any]:
        """What goes into the results."""
        return {
            "normal_n": float(np.median(self.normal_n[self.sliding])) if self.sliding.any() else None,
            "static_peak_n": self.static_peak_n,
            "kinetic_n": self.kinetic_n if self.sliding.any() else None,
            "friction_error_n": self.friction_error_n if self.sliding.any() else None,
            "break_away_s": float(self.time_s[self.break_away]),
            "creep_m": self.creep_m,
            "way_m": float(self.x_m[-1] - self.x_m[0]),
            "unwanted_active_work_j": self.active_work_j,
            "work_on_hand_j": self.work_on_hand_j,
            "hand_work_j": self.hand_work_j,
            "swing_m": self.swing_m,
            "stable": self.stable,
        }

    def trace(self) -> NDArray[Any]:
        """All tick records."""
        return self.records


def dragged(run: Run, strength: str, system: str, law: dict[str, Any] | None = None) -> Drag:
    """Presses on the wall, rests, then rubs along it on a minimum-jerk path."""
    rate_hz, pull_s = run.number("rate_hz"), run.number("pull_s")
    twin = run.twin(MODEL, rate_hz=rate_hz)
    twin.scene({"walls": [wall(run, system, law or RIGID)]})
    twin.enable()
    twin.run(SETTLE_S)
    start_m, end_m = path(run, strength)
    twin.hand({"type": "follow", "target_m": start_m})
    twin.run(2.0 * SETTLE_S)
    twin.hand({"type": "minimum_jerk", "from_m": start_m, "to_m": end_m, "duration_s": pull_s})
    records = twin.run(pull_s + 2.0 * SETTLE_S)
    return Drag(records, rate_hz, run.number("kinetic"))


def wall(run: Run, system: str, law: dict[str, Any]) -> dict[str, Any]:
    """The wall: its force by the motors alone, its friction by what the system has for it."""
    friction = {
        "static": max(run.number("static"), run.number("kinetic")),
        "kinetic": run.number("kinetic"),
        "actuator": SYSTEMS[system],
    }
    return flat_plane([0.0, 1.0, 0.0], run.number("surface_y_m"), law, brake=False, friction=friction)


def path(run: Run, strength: str) -> tuple[list[float], list[float]]:
    """Where the hand means to begin and to end: as far behind the wall as its springs need for the push."""
    hand = json.loads(run.model(MODEL).twin_json)["hand"]
    springs = hand["arm_stiffness_n_per_m"], hand["grip_stiffness_n_per_m"]
    y_m = run.number("surface_y_m") - run.number(f"{strength}_push_n") * sum(1.0 / k for k in springs)
    half_m = 0.5 * run.number("way_m")
    return [-half_m, y_m, 0.0], [half_m, y_m, 0.0]


def largest_stable_n_per_m(run: Run, system: str) -> float | None:
    """The stiffest wall up to which every softer one comes to rest under the strong push; None for none."""

    def stands(stiffness: float) -> bool:
        law = {"type": "spring", "stiffness_n_per_m": stiffness, "damping_n_s_per_m": 0.0}
        return dragged(run, "strong", system, law).stable

    until = 0.7 if system == "active" else 1.0
    steady = run.map(stands, STIFFNESSES_N_PER_M, doing=f"stiffening, {system}", until=until)
    standing = [*steady, False].index(False)
    return STIFFNESSES_N_PER_M[standing - 1] if standing else None
