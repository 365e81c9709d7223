"""The bounds on the motors, found by search instead of by formula."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
SEARCH_STEPS = 60


def largest_share(holds: Callable[[float], bool]) -> float:
    """Largest s in 0…1 for which `holds`, if it holds at 0 and then stops somewhere."""
    if holds(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(SEARCH_STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


@dataclass(frozen=True)
class Limits:
    """What a torque must obey."""

    force_n: float
    slew_n: float
    jacobian_inverse: Vector
    peak_nm: Vector
    retain: Vector
    emf_v: Vector
    v_per_nm: Vector
    max_v: Vector

    def allows(self, torque_nm: Vector) -> bool:
        """Tip force, joint torque and supply."""
        force_n = float(np.linalg.norm(self.jacobian_inverse.T @ torque_nm))
        volts = self.emf_v + self.v_per_nm * torque_nm
        inside = (np.abs(torque_nm) <= self.peak_nm).all() and (np.abs(volts) <= self.max_v).all()
        return force_n <= self.force_n and bool(inside)

    def limited(self, torque_nm: Vector) -> Vector:
        """The torque, scaled as a whole until it is allowed."""
        return largest_share(lambda share: self.allows(share * torque_nm)) * torque_nm

    def slow(self, step_nm: Vector) -> bool:
        """Whether a step of the command changes the tip force slowly enough."""
        given_nm = (1 - self.retain) * step_nm
        return float(np.linalg.norm(self.jacobian_inverse.T @ given_nm)) <= self.slew_n

    def bounded(self, asked_nm: Vector, present_nm: Vector) -> Vector:
        """Into the limits, from there towards the present torque as the slew demands, and into
        the limits again."""
        step_nm = self.limited(asked_nm) - present_nm
        share = largest_share(lambda share: self.slow(share * step_nm))
        return self.limited(present_nm + share * step_nm)
