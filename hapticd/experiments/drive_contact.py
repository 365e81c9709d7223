"""The same hand meets a wall on the twin's spring drive and on a current amplifier at the same tip."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.linear_loop import LinearLoop
from hapticd.analysis.one_axis_contact import Axis, Contact, DigitalWall, Operator, meet
from hapticd.analysis.passivity_limit import SampledWall
from hapticd.experiments.drive_limits import best_damped
from hapticd.experiments.drive_tuning import MODEL, tuned
from hapticd.experiments.plane_wall import plane_wall
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]

POSE_RAD = np.array([0.0, 0.9, 0.9])
"""Links perpendicular: across the upper link, joint 2 moves alone."""

JOINT = 1

PEAK_OVER_MEAN = 1.875
"""Largest over mean speed of a minimum-jerk path."""

RISE_S = 0.01
"""Time after the touch in which the rise of the force is looked at."""

LAST_S = 0.2
"""Time at the end that counts as steady."""

APART_M = 1e-4
"""How far out the tip must go for a touch to have ended."""


@dataclass(frozen=True)
class Touch:
    """One contact and what it shows."""

    contact: Contact

    def numbers(self) -> dict[str, float]:
        """Impact speed, deepest, rate-hardness, touches; at the end motion, force, energy."""
        c = self.contact
        first = int(np.argmax(c.depth_m > 0.0))
        rising = slice(first, first + max(2, round(RISE_S / self._period_s)))
        speed = float(c.speed_m_per_s[first])
        hardness = float(np.max(np.diff(c.force_n[rising]))) / self._period_s / max(speed, 1e-9)
        last = c.time_s > c.time_s[-1] - LAST_S
        return {
            "impact_m_per_s": speed,
            "max_depth_m": float(c.depth_m.max()),
            "rate_hardness_n_per_m": hardness,
            "touches": self._touches(),
            "residual_m": float(np.ptp(c.depth_m[last])),
            "steady_force_n": float(np.mean(c.force_n[last])),
            "returned_over_received": self._returned(),
        }

    def trace(self) -> dict[str, Vector]:
        """As a table."""
        c = self.contact
        return {
            "time_s": c.time_s,
            "depth_m": c.depth_m,
            "speed_m_per_s": c.speed_m_per_s,
            "wall_force_n": c.force_n,
        }

    @property
    def _period_s(self) -> float:
        return float(self.contact.time_s[1] - self.contact.time_s[0])

    def _touches(self) -> int:
        inside, count = False, 0
        for depth_m in self.contact.depth_m:
            if not inside and depth_m > 0.0:
                inside, count = True, count + 1
            elif inside and depth_m < -APART_M:
                inside = False
        return count

    def _returned(self) -> float:
        """Energy the wall gave back over that it took, by force and travel between ticks."""
        c = self.contact
        work = 0.5 * (c.force_n[1:] + c.force_n[:-1]) * np.diff(c.depth_m)
        return float(-work[work < 0].sum() / max(work[work > 0].sum(), 1e-12))


def touches(run: Run) -> dict[str, Touch]:
    """The spring drive on the twin; the current drive as stiff, bare and damped, and within its passivity."""
    axis, operator = axis_of(run), operator_of(run)
    walls = walls_of(run, axis)

    def touch(name: str) -> Touch:
        if name == "spring_drive":
            return Touch(_on_twin(run, operator))
        return Touch(meet(axis, walls[name], operator, run.number("duration_s")))

    names = ["spring_drive", *walls]
    return dict(zip(names, run.map(touch, names, doing="touching"), strict=True))


def walls_of(run: Run, axis: Axis) -> dict[str, DigitalWall]:
    """The digital walls of the current drive."""
    rate_hz, delay_ticks = run.number("rate_hz"), run.integer("delay_ticks")
    lam, friction = run.number("lambda_rad_per_s"), run.number("viscous_n_s_per_m")
    device = (axis.mass_kg, axis.viscous_n_s_per_m, rate_hz, delay_ticks / rate_hz, axis.lag_s, lam)
    port = SampledWall(friction, rate_hz, delay_ticks / rate_hz, axis.lag_s, lam)
    stiffness = static_stiffness(run)
    gains = {
        "current_bare": (stiffness, 0.0),
        "current_damped": (stiffness, damping_for(LinearLoop(*device), stiffness)),
        "current_passive": (port.largest_stiffness_n_per_m(0.0), 0.0),
    }
    return {
        name: DigitalWall(
            *gain, rate_hz, delay_ticks, quantum_m(run), lam, force_max_n=run.number("force_max_n")
        )
        for name, gain in gains.items()
    }


def damping_for(loop: LinearLoop, stiffness_n_per_m: float) -> float:
    """The damping that makes a wall of this stiffness die away fastest, N·s/m."""
    dampings = np.geomspace(0.1, max(best_damped(loop)[1], 0.2), 60)
    return float(
        min(dampings, key=lambda damping: loop.largest_eigenvalue(stiffness_n_per_m, float(damping)))
    )


def axis_of(run: Run) -> Axis:
    """The twin's tip across its upper link, with a current amplifier in place of the spring drive."""
    model = run.model(MODEL)
    twin = json.loads(model.twin_json)
    column = _column(run)
    inertia: Vector = np.array(_core.mass_matrix(model.device_json, model.twin_json, POSE_RAD.tolist()))
    jacobian = np.array(_core.Kinematics(model.device_json).jacobian(POSE_RAD))
    across = column / np.linalg.norm(column)
    mobility = across @ jacobian @ np.linalg.solve(inertia, jacobian.T) @ across
    arm = float(np.linalg.norm(column))
    friction = twin["friction"]
    return Axis(
        1.0 / float(mobility),
        friction["viscous_nm_s_per_rad"][JOINT] / arm**2,
        friction["coulomb_nm"][JOINT] / arm,
        run.number("current_lag_s"),
    )


def operator_of(run: Run) -> Operator:
    """The twin's hand on a path that meets the wall with its largest speed."""
    hand: dict[str, Any] = json.loads(run.model(MODEL).twin_json)["hand"]
    travel = run.number("travel_m")
    return Operator(
        hand["mass_kg"],
        hand["grip_stiffness_n_per_m"],
        hand["grip_damping_n_s_per_m"],
        hand["arm_stiffness_n_per_m"],
        hand["arm_damping_n_s_per_m"],
        travel,
        PEAK_OVER_MEAN * travel / run.number("approach_m_per_s"),
    )


def static_stiffness(run: Run) -> float:
    """K_DC of joint 2 at the tip, across the upper link, N/m."""
    drive = json.loads(run.model(MODEL, tuned(run)).device_json)["drive"]
    d_r = np.array(drive["r_25_ohm"]) - np.array(drive["r_hat_ohm"])
    k_q = _core.SpringDrive(run.model(MODEL, tuned(run)).device_json).dc_stiffness(d_r)[JOINT]
    return float(k_q / np.linalg.norm(_column(run)) ** 2)


def quantum_m(run: Run) -> float:
    """One count of joint 2 at the tip, m."""
    counts = json.loads(run.model(MODEL).device_json)["joints"]["counts_per_rad"][JOINT]
    return float(np.linalg.norm(_column(run)) / abs(counts))


def _column(run: Run) -> Vector:
    return np.array(_core.Kinematics(run.model(MODEL).device_json).jacobian(POSE_RAD))[:, JOINT]


def _on_twin(run: Run, operator: Operator) -> Contact:
    """The twin's spring drive, under inverse mapping, so that joint 2 is as stiff as tuned."""
    kinematics = _core.Kinematics(run.model(MODEL).device_json)
    surface = np.array(kinematics.forward(POSE_RAD))
    into = _column(run) / np.linalg.norm(_column(run))
    start = surface - 0.5 * operator.travel_m * into
    home = kinematics.inverse(start)
    if home is None:
        raise ValueError(f"The linkage does not reach {start}.")
    overrides = {
        **tuned(run),
        "joints.home_rad": home,
        "limits.tip_force_n": run.number("force_max_n"),
        "twin.command_delay_ticks": run.integer("delay_ticks") - 1,
    }
    twin = run.twin(MODEL, rate_hz=run.number("rate_hz"), overrides=overrides)
    twin.scene({"mapping": "inverse", "walls": [plane_wall(-into, float(-into @ surface))]})
    twin.enable()
    twin.run(0.4)
    begin, end = start.tolist(), (start + operator.travel_m * into).tolist()
    twin.hand({"type": "minimum_jerk", "from_m": begin, "to_m": end, "duration_s": operator.duration_s})
    records = twin.run(run.number("duration_s"))
    return Contact(
        np.arange(len(records)) / twin.rate_hz,
        (records["tip_position_m"] - surface) @ into,
        records["tip_velocity_m_per_s"] @ into,
        _motor_force(run, records["motor_current_a"][:, JOINT]),
    )


def _motor_force(run: Run, current_a: Vector) -> Vector:
    """Force of joint 2's motor out of the wall, by its current, N."""
    drive = json.loads(run.model(MODEL).device_json)["drive"]
    per_ampere = drive["ratio"][JOINT] * drive["k_t_nm_per_a"][JOINT]
    found: Vector = -per_ampere * current_a / np.linalg.norm(_column(run))
    return found
