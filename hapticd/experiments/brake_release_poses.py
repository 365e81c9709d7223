"""The directions of KS Fig. 5 in closed form, at a few poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hapticd import _core

Vector = NDArray[np.float64]

POSES_M = ((0.0, 0.2), (0.06, 0.2), (0.12, 0.22))
"""Three tips with the wall's normal along −y (physics §5)."""

NORMAL = np.array([0.0, -1.0])
FORCE_N = 40.0


@dataclass(frozen=True)
class ReleasePose:
    """Forces of the motor on joint 1 and the brake on joint 2, N, and how far the sum is off the normal."""

    point_m: tuple[float, float]
    motor_n: Vector
    brake_n: Vector

    @property
    def compression_deg(self) -> float:
        """Angle of the sum to the normal while the brake opposes the motion inwards."""
        return _off_normal_deg(self.motor_n + self.brake_n)

    @property
    def release_deg(self) -> float:
        """The same with the brake's torque reversed, as it opposes the motion outwards (KS Fig. 5b)."""
        return _off_normal_deg(self.motor_n - self.brake_n)

    @property
    def let_go_deg(self) -> float:
        """The same with the brake released: the motor alone."""
        return _off_normal_deg(self.motor_n)

    def numbers(self) -> dict[str, float | list[float]]:
        """The angles."""
        return {
            "point_m": list(self.point_m),
            "compression_deg": self.compression_deg,
            "release_deg": self.release_deg,
            "brake_let_go_deg": self.let_go_deg,
        }


def closed_forms(device_json: str) -> list[ReleasePose]:
    """τ = Jᵀ F along the normal, split into what each joint gives at the tip."""
    kinematics = _core.Kinematics(device_json)
    return [_at(kinematics, pose) for pose in POSES_M]


def _at(kinematics: _core.Kinematics, pose: tuple[float, float]) -> ReleasePose:
    q = kinematics.inverse((*pose, 0.0))
    if q is None:
        raise ValueError(f"The tip does not reach {pose}.")
    jacobian = np.array(kinematics.jacobian(q))[:2, :2]
    torque = jacobian.T @ (FORCE_N * NORMAL)
    columns = np.linalg.inv(jacobian.T)
    return ReleasePose(pose, columns[:, 0] * torque[0], columns[:, 1] * torque[1])


def _off_normal_deg(force: Vector) -> float:
    cosine = float(force @ NORMAL) / float(np.linalg.norm(force))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
