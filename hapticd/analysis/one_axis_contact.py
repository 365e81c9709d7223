"""One axis with a current amplifier meets a digital wall in the hand of an operator: a small simulation."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

STEPS = 20
"""Steps of the plant in a tick."""


@dataclass(frozen=True, slots=True)
class Operator:
    """Hand and arm, as the twins have them, on a minimum-jerk path through the wall. SI units."""

    mass_kg: float
    grip_stiffness_n_per_m: float
    grip_damping_n_s_per_m: float
    arm_stiffness_n_per_m: float
    arm_damping_n_s_per_m: float
    travel_m: float
    duration_s: float

    def intention(self, time_s: float) -> tuple[float, float]:
        """Place, m, half the travel before to half behind the wall, and speed, m/s (Flash & Hogan)."""
        s = min(max(time_s / self.duration_s, 0.0), 1.0)
        share = s**3 * (10 - 15 * s + 6 * s**2)
        rate = 30 * s**2 * (1 - s) ** 2 / self.duration_s
        return self.travel_m * (share - 0.5), self.travel_m * rate


@dataclass(frozen=True, slots=True)
class DigitalWall:
    """F = −K x̂ − B v̂ inside, never pulling; sampled, quantised, held, late, at most ``force_max_n``."""

    stiffness_n_per_m: float
    damping_n_s_per_m: float
    rate_hz: float
    delay_ticks: int
    quantum_m: float
    lambda_rad_per_s: float
    force_max_n: float


@dataclass(frozen=True, slots=True)
class Axis:
    """Mass of the tip, viscous and Coulomb friction, lag of the amplifier."""

    mass_kg: float
    viscous_n_s_per_m: float
    coulomb_n: float
    lag_s: float


@dataclass(frozen=True)
class Contact:
    """By tick: time s, depth m (negative outside), speed m/s into the wall, force of the wall N."""

    time_s: Real
    depth_m: Real
    speed_m_per_s: Real
    force_n: Real


def meet(axis: Axis, wall: DigitalWall, operator: Operator, duration_s: float) -> Contact:
    """The axis begins at rest half the travel before the wall."""
    plant = _Plant(axis, operator, wall.rate_hz)
    controller = _Controller(wall, plant.x)
    rows = []
    for tick in range(round(duration_s * wall.rate_hz)):
        rows.append((tick / wall.rate_hz, plant.x, plant.v, plant.force))
        plant.tick(controller.command(plant.x))
    return Contact(*np.array(rows).T)


class _Controller:
    def __init__(self, wall: DigitalWall, x: float) -> None:
        self.wall = wall
        self.waiting = deque([0.0] * wall.delay_ticks)
        self.keep = math.exp(-wall.lambda_rad_per_s / wall.rate_hz)
        self.before = self._count(x)
        self.velocity = 0.0

    def _count(self, x: float) -> float:
        return round(x / self.wall.quantum_m) * self.wall.quantum_m

    def command(self, x: float) -> float:
        """Force out of the wall, N, that is in force in this tick."""
        wall, seen = self.wall, self._count(x)
        slope = (seen - self.before) * wall.rate_hz
        self.velocity = self.keep * self.velocity + (1 - self.keep) * slope
        self.before = seen
        spring = wall.stiffness_n_per_m * seen + wall.damping_n_s_per_m * self.velocity
        self.waiting.append(min(max(spring, 0.0), wall.force_max_n) if seen > 0.0 else 0.0)
        return self.waiting.popleft()


class _Plant:
    def __init__(self, axis: Axis, operator: Operator, rate_hz: float) -> None:
        self.axis, self.operator = axis, operator
        self.h = 1.0 / (rate_hz * STEPS)
        self.time_s = 0.0
        self.x = self.hand_x = operator.intention(0.0)[0]
        self.v = self.hand_v = self.force = 0.0
        self.keep = math.exp(-self.h / axis.lag_s) if axis.lag_s > 0.0 else 0.0

    def tick(self, command_n: float) -> None:
        for _ in range(STEPS):
            self.force = command_n + self.keep * (self.force - command_n)
            self._step()

    def _step(self) -> None:
        axis, hand, h = self.axis, self.operator, self.h
        self.time_s += h
        goal, goal_v = hand.intention(self.time_s)
        grip = hand.grip_stiffness_n_per_m * (self.hand_x - self.x)
        grip += hand.grip_damping_n_s_per_m * (self.hand_v - self.v)
        arm = hand.arm_stiffness_n_per_m * (goal - self.hand_x)
        arm += hand.arm_damping_n_s_per_m * (goal_v - self.hand_v)
        self.hand_v += (arm - grip) * h / hand.mass_kg
        self.hand_x += self.hand_v * h
        free = self.v + (grip - self.force - axis.viscous_n_s_per_m * self.v) * h / axis.mass_kg
        stick = axis.coulomb_n * h / axis.mass_kg
        self.v = math.copysign(max(abs(free) - stick, 0.0), free)
        self.x += self.v * h
