"""The twin pushing against a clamp: what force really arrives at the tip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.plane_wall import plane_wall
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]

POSES_M = ((0.0, 0.2), (0.0, 0.09), (0.0, 0.32), (0.19, 0.09), (0.19, 0.32))
"""The middle, the nearest, the farthest and two corners of the workspace (KS §2.1)."""

DEPTH_M = 0.01
"""Deep enough that the coupling asks for more than every limit."""

REACH_S = 1.2
"""The clamp carries the tip to its pose."""

PUSH_S = 0.5
"""Past the ramp into `enabled`, before the motors fold back."""

REST_S = 0.1


@dataclass(frozen=True)
class Pushes:
    """One entry per push: where, in which direction, and the mean force on the clamp."""

    point_m: NDArray[np.float64]
    direction_rad: Vector
    force_n: NDArray[np.float64]

    @property
    def along_n(self) -> Vector:
        """Force along the direction wanted."""
        direction = np.stack([np.cos(self.direction_rad), np.sin(self.direction_rad)], axis=1)
        return np.asarray(np.sum(direction * self.force_n, axis=1))

    def numbers(self) -> dict[str, Any]:
        """The weakest push."""
        weakest = int(self.along_n.argmin())
        return {
            "smallest_n": float(self.along_n[weakest]),
            "weakest_point_m": self.point_m[weakest].tolist(),
            "weakest_direction_deg": float(np.degrees(self.direction_rad[weakest])),
            "count": len(self.along_n),
        }

    def trace(self) -> dict[str, Vector]:
        """The pushes as a table."""
        return {
            "x_m": self.point_m[:, 0],
            "y_m": self.point_m[:, 1],
            "direction_rad": self.direction_rad,
            "force_x_n": self.force_n[:, 0],
            "force_y_n": self.force_n[:, 1],
        }


def pushed(run: Run, model: str) -> Pushes:
    """Clamps the twin's tip behind a wall at every pose and reads the clamp, by motors alone."""
    angles = np.linspace(0.0, 2.0 * np.pi, run.integer("push_directions"), endpoint=False)
    cases = [(pose, float(angle)) for pose in POSES_M for angle in angles]
    forces = run.map(lambda case: _push(run, model, *case), cases, doing="pushing")
    return Pushes(
        point_m=np.array([pose for pose, _ in cases]),
        direction_rad=np.array([angle for _, angle in cases]),
        force_n=np.array(forces),
    )


def _push(run: Run, model: str, pose: tuple[float, float], angle: float) -> tuple[float, float]:
    twin = run.twin(model)
    twin.hand({"type": "clamp", "position_m": [*pose, 0.0]})
    twin.run(REACH_S)
    normal = np.array([np.cos(angle), np.sin(angle), 0.0])
    point = np.array([*pose, 0.0]) + DEPTH_M * normal
    wall = plane_wall(normal, float(normal @ point))
    twin.scene({"walls": [wall], "allocation": "motor_only"})
    twin.enable()
    twin.run(PUSH_S)
    x, y, _ = np.mean(-twin.run(REST_S)["hand_force_n"], axis=0)
    return float(x), float(y)
