"""The wall of KS Figs. 8(b) and 9(b): a spring with a passivity observer and controller, as published.

Rendered here against the bare plant: hapticd's own passivity control does more than this (docs/passivity.md).
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.experiments.run import Run
from hapticd.experiments.wall_contact_approach import MODEL

OBSERVATION = struct.Struct("<QQ3q3dd3dQ")
COMMAND = struct.Struct("<10d")

ALPHA_MAX = 600.0
"""Largest damping that the controller adds, N·s/m (physics §6, set R1)."""

V_MIN = 2e-3
"""Speed below which quantisation hides the velocity, m/s (physics §6)."""

REACH_S = 2.0
"""The hand goes to where it sets out."""

TICK = np.dtype(
    [
        ("tip_position_m", "<f8", (3,)),
        ("tip_velocity_m_per_s", "<f8", (3,)),
        ("sensor_force_n", "<f8", (3,)),
        ("tip_force_command_n", "<f8", (3,)),
        ("device_energy_j", "<f8"),
    ]
)
"""The fields of a tick record that a contact is judged by."""


@dataclass
class Popc:
    """A spring wall at ``y_m`` with normal −y, its observer and its controller (Hannaford & Ryu 2002).

    The observer counts the energy of the force really applied, f̂ Δx, with the motors' lag (physics §6): the
    published same-sample form never acts for a spring.
    """

    y_m: float
    k: float
    force_max_n: float
    lag_s: float
    period_s: float
    energy_j: float = 0.0
    applied_n: float = 0.0
    asked_n: float = 0.0
    before_m: float = 0.0

    def force_n(self, y_m: float, v: float) -> float:
        """Force against +y, N, for a tip at ``y_m`` moving at ``v``, m/s."""
        depth, keep = y_m - self.y_m, math.exp(-self.period_s / self.lag_s)
        after = self.asked_n + (self.applied_n - self.asked_n) * keep
        mean = self.asked_n + (self.applied_n - after) * self.lag_s / self.period_s
        self.applied_n = after
        self.energy_j += mean * (y_m - self.before_m)
        self.before_m = y_m
        f = self.k * max(0.0, depth)
        if depth > 0.0 and self.energy_j < 0.0:
            f += self._alpha(v) * v
        self.asked_n = float(np.clip(f, -self.force_max_n, self.force_max_n))
        return self.asked_n

    def _alpha(self, v: float) -> float:
        return min(ALPHA_MAX, -self.energy_j / (self.period_s * max(v * v, V_MIN * V_MIN)))


class PopcBench:
    """Plant and wall, tick by tick; the command acts in the tick after its observation."""

    def __init__(self, run: Run) -> None:
        model, device = run.model(MODEL), json.loads(run.model(MODEL).device_json)
        rate_hz, joints = run.number("rate_hz"), device["joints"]
        self._plant = _core.Plant(model.device_json, model.twin_json, rate_hz, run.seed)
        self._kinematics = _core.Kinematics(model.device_json)
        self._wall = Popc(
            y_m=run.number("wall_y_m"),
            k=run.number("stiffness_n_per_m"),
            force_max_n=device["limits"]["tip_force_n"],
            lag_s=device["drive"]["lag_s"],
            period_s=1.0 / rate_hz,
        )
        self._zero = np.array(joints["zero_rad"][:2])
        self._scale = 1.0 / np.array(joints["counts_per_rad"][:2])
        self._keep = math.exp(-device["estimator"]["lambda_rad_per_s"] / rate_hz)
        self._limit = np.array(device["drive"]["torque_max_nm"][:2])
        self._q: NDArray[np.float64] | None = None
        self._qd = np.zeros(2)
        self._torque = np.zeros(2)
        self.hand({"type": "follow", "target_m": [0.0, run.number("start_y_m"), 0.0]})
        self.run(REACH_S)

    def hand(self, script: Mapping[str, Any]) -> None:
        """Tells the hand what to do."""
        self._plant.hand(json.dumps(dict(script)))

    def run(self, duration_s: float) -> NDArray[Any]:
        """The ticks of ``duration_s``: a structured array with what a contact is judged by."""
        ticks = round(duration_s / self._wall.period_s)
        return np.array([self._tick() for _ in range(ticks)], dtype=TICK)

    def _tick(self) -> tuple[Any, ...]:
        command = COMMAND.pack(1.0, 0.0, 0.0, 0.0, *self._torque, 0.0, 0.0, 0.0, 0.0)
        observation = OBSERVATION.unpack(self._plant.step(command))
        q = self._zero + self._scale * np.array(observation[2:4], dtype=np.float64)
        if self._q is not None:
            step = (q - self._q) / self._wall.period_s
            self._qd = self._keep * self._qd + (1.0 - self._keep) * step
        self._q = q
        pose = (float(q[0]), float(q[1]), 0.0)
        jacobian = np.array(self._kinematics.jacobian(pose))[:2, :2]
        x, v = np.array(self._kinematics.forward(pose)), jacobian @ self._qd
        force = np.array([0.0, -self._wall.force_n(float(x[1]), float(v[1]))])
        torque = jacobian.T @ force
        self._torque = torque * min(1.0, float(np.min(self._limit / np.maximum(np.abs(torque), 1e-9))))
        return (tuple(x), (*v, 0.0), observation[5:8], (*force, 0.0), self._wall.energy_j)
