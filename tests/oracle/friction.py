"""Coulomb friction with stick (physics §7): an elastic anchor for motors, a direction for brakes."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

AVERAGE_S = 0.01
RESTICK_M_PER_S = 0.002
SLIDING_M_PER_S = 0.004
PULL_MIN_N = 0.3


def zero() -> Vector:
    """The null vector."""
    return np.zeros(3)


def along(vector: Vector, normal: Vector) -> Vector:
    """The part of a vector along a surface."""
    return np.asarray((np.eye(3) - np.outer(normal, normal)) @ vector)


@dataclass
class Average:
    """Low-pass over ``AVERAGE_S``, one Euler step a tick."""

    period_s: float
    value: Vector = field(default_factory=zero)

    def follow(self, sample: Vector) -> float:
        """Length of the average after one more sample."""
        share = self.period_s / AVERAGE_S
        self.value = (1 - share) * self.value + share * sample
        return float(np.linalg.norm(self.value))


@dataclass
class Anchor:
    """The tip hangs on a spring and a damper at a point that slides once the spring pulls too hard."""

    stiffness: float
    damping: float
    slide: Average
    tip: Vector
    anchor: Vector
    sticks: bool = True

    def force(self, normal: Vector, tip: Vector, velocity: Vector, limits: tuple[float, float]) -> Vector:
        """Force after the tip has come to ``tip``; ``limits`` are μ_s N and μ_k N."""
        stretch = along(tip - self.anchor, normal)
        pull = self.stiffness * float(np.linalg.norm(stretch))
        self.sticks = self.sticks and pull <= limits[0]
        limit = limits[0] if self.sticks else limits[1]
        kept = stretch * min(1.0, limit / pull) if pull > 0 else stretch
        way = float(np.linalg.norm(stretch - kept))
        self.anchor = tip - kept
        slide = self.slide.follow(np.array([way / self.slide.period_s, 0.0, 0.0]))
        self.sticks = self.sticks or slide < RESTICK_M_PER_S
        spring, damper = -self.stiffness * kept, -self.damping * along(velocity, normal)
        return spring + share_within(spring, damper, limit) * damper


def share_within(spring: Vector, damper: Vector, limit: float) -> float:
    """Largest share of ``damper`` that keeps the sum within ``limit``, by bisection."""
    if np.linalg.norm(spring + damper) <= limit:
        return 1.0 if damper.any() else 0.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = np.linalg.norm(spring + middle * damper) <= limit
        low, high = (middle, high) if inside else (low, middle)
    return low


@dataclass
class Heading:
    """Which way a brake's friction points: against the slip, at rest against the hand."""

    speed: Average
    direction: Vector = field(default_factory=zero)
    sticks: bool = True

    def force(self, normal: Vector, velocity: Vector, hand: Vector, limits: tuple[float, float]) -> Vector:
        """Force that the brakes may give."""
        speed = self.speed.follow(along(velocity, normal))
        if speed > SLIDING_M_PER_S or speed < RESTICK_M_PER_S:
            self.sticks = speed < RESTICK_M_PER_S
        pull = along(hand, normal)
        if not self.sticks:
            self.direction = self.speed.value / speed
        elif np.linalg.norm(pull) > PULL_MIN_N:
            self.direction = pull / np.linalg.norm(pull)
        return -limits[0 if self.sticks else 1] * self.direction


def normal_forces(normals: Vector, hand: Vector) -> Vector:
    """N_i ≥ 0 with Σ N_i n_i closest to the hand's push, for walls with independent normals: (count,)."""
    best, least = np.zeros(len(normals)), float(np.linalg.norm(hand))
    for bits in range(1, 2 ** len(normals)):
        chosen = [i for i in range(len(normals)) if bits >> i & 1]
        fit, *_ = np.linalg.lstsq(normals[chosen].T, -hand, rcond=None)
        rest = float(np.linalg.norm(normals[chosen].T @ fit + hand))
        if (fit >= 0).all() and rest < least - 1e-12:
            best, least = np.zeros(len(normals)), rest
            best[chosen] = fit
    return best
