"""The workspace of the HHD, point by point: joint angles, singularities, and force of motors and brakes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.force_ellipse import ball_force_n, box_force_n, smallest_ball_force_n
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]

INFERRED_BRAKE_NM = 10.0
"""Joint torque of a brake that would give the 36 N which KS state (physics §4.1)."""


@dataclass(frozen=True)
class WorkspaceMap:
    """One entry per point of the grid; ``reachable`` marks those inside the joint limits of KS §2.1."""

    point_m: NDArray[np.float64]
    q_rad: NDArray[np.float64]
    jacobian: NDArray[np.float64]
    motor_nm: float
    brake_readings_nm: Mapping[str, float]
    directions_rad: Vector

    @property
    def margin(self) -> Vector:
        """sin of the opening θ2 − θ1: 0 at a singularity."""
        return np.asarray(np.sin(self.q_rad[:, 1] - self.q_rad[:, 0]))

    @property
    def condition(self) -> Vector:
        """Condition number of J."""
        return np.array([np.linalg.cond(jacobian) for jacobian in self.jacobian])

    def smallest_n(self, torque_nm: float) -> Vector:
        """Smallest force over all directions at each point, ‖τ‖₂ bounded, N."""
        return np.array([smallest_ball_force_n(jacobian, torque_nm) for jacobian in self.jacobian])

    def ball_n(self, torque_nm: float) -> NDArray[np.float64]:
        """Force at each point in each direction, ‖τ‖₂ bounded, N; (points, directions)."""
        return np.array([ball_force_n(j, torque_nm, self.directions_rad) for j in self.jacobian])

    def box_n(self, torque_nm: float) -> NDArray[np.float64]:
        """Force at each point in each direction, each |τᵢ| bounded, N; (points, directions)."""
        return np.array([box_force_n(j, torque_nm, self.directions_rad) for j in self.jacobian])

    def numbers(self) -> dict[str, Any]:
        """What the paper states about the workspace, as found."""
        motor = self.smallest_n(self.motor_nm)
        return {
            "joint_range_deg": np.degrees([self.q_rad.min(axis=0), self.q_rad.max(axis=0)]).T.tolist(),
            "smallest_margin": float(self.margin.min()),
            "largest_condition": float(self.condition.max()),
            "motors": {
                "smallest_n": float(motor.min()),
                "weakest_point_m": self.point_m[int(motor.argmin())].tolist(),
                "smallest_as_box_n": float(self.box_n(self.motor_nm).min()),
                "share_of_100_n": float(np.mean(self.ball_n(self.motor_nm) >= 100.0)),
                "share_of_points_with_100_n": float(np.mean(motor >= 100.0)),
            },
            "brakes": {
                name: {
                    "joint_nm": torque_nm,
                    "smallest_n": float(self.smallest_n(torque_nm).min()),
                    "smallest_as_box_n": float(self.box_n(torque_nm).min()),
                }
                for name, torque_nm in self.brake_readings_nm.items()
            },
        }

    def trace(self) -> dict[str, Vector]:
        """The map as a table."""
        return {
            "x_m": self.point_m[:, 0],
            "y_m": self.point_m[:, 1],
            "q1_rad": self.q_rad[:, 0],
            "q2_rad": self.q_rad[:, 1],
            "singularity_margin": self.margin,
            "motor_force_n": self.smallest_n(self.motor_nm),
            "brake_force_n": self.smallest_n(self.brake_readings_nm["inferred"]),
        }


def surveyed(run: Run, device_json: str) -> WorkspaceMap:
    """The map that the run's parameters ask for."""
    kinematics = _core.Kinematics(device_json)
    points = _grid(run.number("x_max_m"), run.vector("y_m"), run.number("step_m"))
    q = np.array([kinematics.inverse((x, y, 0.0)) for x, y in points])
    shaft, ratio = run.number("brake_nm"), run.number("pulley_ratio")
    return WorkspaceMap(
        point_m=points,
        q_rad=q[:, :2],
        jacobian=np.array([kinematics.jacobian(pose) for pose in q.tolist()])[:, :2, :2],
        motor_nm=run.number("motor_nm"),
        brake_readings_nm={
            "before_the_pulley": shaft * ratio,
            "at_the_joint": shaft,
            "inferred": INFERRED_BRAKE_NM,
        },
        directions_rad=np.linspace(0.0, np.pi, run.integer("directions"), endpoint=False),
    )


def _grid(x_max_m: float, y_m: tuple[float, ...], step_m: float) -> NDArray[np.float64]:
    x = np.linspace(-x_max_m, x_max_m, 1 + round(2 * x_max_m / step_m))
    y = np.linspace(y_m[0], y_m[1], 1 + round((y_m[1] - y_m[0]) / step_m))
    return np.array([(a, b) for a in x for b in y])
