"""Sharing a joint torque between motor and brake (physics §5), and the brake itself (§4.3)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
HAND_OVER_S = 0.015
RELIEF_SHARE = 0.8


@dataclass
class ParticleBrake:
    """One brake: play hysteresis, lag, dead time."""

    rated_nm: float
    lag_s: float
    dead_time_s: float
    hysteresis: float
    period_s: float
    commands: list[float] = field(default_factory=list)
    play: float = 0.0
    torque_nm: float = 0.0

    def step(self, asked_nm: float) -> float:
        """Torque built up after one more period."""
        self.commands.append(asked_nm / self.rated_nm)
        age = len(self.commands) - 1 - round(self.dead_time_s / self.period_s)
        u = self.commands[age] if age >= 0 else 0.0
        self.play = min(max(self.play, u - self.hysteresis), u + self.hysteresis)
        target = self.rated_nm * max(self.play, 0.0)
        self.torque_nm = target + (self.torque_nm - target) * float(np.exp(-self.period_s / self.lag_s))
        return self.torque_nm


@dataclass(frozen=True)
class Joint:
    """What one joint meets."""

    wanted_nm: float
    qd: float
    hand_nm: float
    brake_nm: float


@dataclass(frozen=True)
class Logic:
    """Thresholds of the brake-direction logic."""

    omega_on: float
    omega_off: float
    hand_min_nm: float
    brake_max_nm: float
    period_s: float

    def usable(self, joint: Joint, before: bool) -> bool:
        """Whether the brake may act: dissipative when moving, against the hand at rest."""
        if abs(joint.qd) > self.omega_on:
            return joint.wanted_nm * joint.qd < 0
        if abs(joint.qd) < self.omega_off:
            return joint.wanted_nm * joint.hand_nm < 0 and abs(joint.hand_nm) > self.hand_min_nm
        return before

    def brake_nm(self, joint: Joint, usable: bool) -> float:
        """τ_b."""
        return min(abs(joint.wanted_nm), self.brake_max_nm) if usable else 0.0

    def motor_nm(self, joint: Joint, usable: bool, before_nm: float) -> float:
        """τ_m: what the brake leaves open; at rest handed over in `HAND_OVER_S`."""
        if abs(joint.qd) >= self.omega_off:
            return joint.wanted_nm + float(np.clip(joint.qd / self.omega_on, -1, 1)) * joint.brake_nm
        if not usable:
            return joint.wanted_nm
        rest = float(np.sign(joint.wanted_nm)) * max(abs(joint.wanted_nm) - joint.brake_nm, 0.0)
        return rest + (before_nm - rest) * float(np.exp(-self.period_s / HAND_OVER_S))

    def relief_nm(self, joint: Joint, usable: bool, motor_nm: float) -> float:
        """What motors add the way the hand pulls against a brake that was let go."""
        net_nm = joint.hand_nm + motor_nm
        pull_nm = min(abs(joint.hand_nm), abs(net_nm)) if joint.hand_nm * net_nm > 0 else 0.0
        share = RELIEF_SHARE * float(np.interp(pull_nm, [self.hand_min_nm, 3 * self.hand_min_nm], [0, 1]))
        if abs(joint.qd) >= self.omega_off:
            against = joint.qd * joint.hand_nm <= 0
            share -= 1.0 if against else min(abs(joint.qd) / self.omega_on, 1.0)
        return 0.0 if usable else float(np.sign(joint.hand_nm)) * max(share, 0.0) * joint.brake_nm


def releasing(logic: Logic, joints: list[Joint], force_n: Vector, hand_n: Vector) -> bool:
    """Whether all brakes let go: the device gives in to the force, or rests unloaded."""
    fastest = max(abs(joint.qd) for joint in joints)
    if fastest > logic.omega_on:
        return sum(joint.wanted_nm * joint.qd for joint in joints) > 0
    return fastest < logic.omega_off and float(force_n @ hand_n) >= 0
