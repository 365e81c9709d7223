"""A PHANTOM whose tip a bench clamp presses into walls of any direction: the set-up of WN Fig. 6."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.flat_wall import rigid_plane
from hapticd.twin import TwinRun

Vector = NDArray[np.float64]

POSE_RAD = (0.0, 0.0, np.pi / 6)
"""q2 = 0, q3 = 30°: tip at (210, 0, −121) mm, where the joints' stiffness is three times stiffer one way."""

DIRECTIONS_RAD = np.radians(np.arange(0.0, 360.0, 15.0))
"""24 wall normals in the plane of the linkage, from the x axis towards z."""

IDEAL: Mapping[str, Any] = {"twin.winding.brush_ripple": 0.0, "twin.friction.coulomb_nm": [0.0, 0.0, 0.0]}
"""Motors and bearings without what hides the law: brush ripple moves a joint's stiffness, friction holds
part of the force."""

COLD: Mapping[str, Any] = {"drive.thermal.winding_s": 1e6}
"""Windings that do not warm up."""


def normal(angle_rad: float) -> Vector:
    """Unit wall normal at an angle in the plane of the linkage."""
    return np.array([np.cos(angle_rad), 0.0, np.sin(angle_rad)])


class ClampedPhantom:
    """Enabled, held by the clamp where it started."""

    def __init__(self, overrides: Mapping[str, Any], mapping: str) -> None:
        self.run = TwinRun("phantom-1.0", overrides={**overrides, "joints.home_rad": list(POSE_RAD)})
        self.mapping = mapping
        self.home: Vector = self.run.truth()["tip_position_m"]
        self.run.enable()
        self._clamp(self.home)

    def press(self, n: Vector, depth_m: float) -> NDArray[Any]:
        """Records of the last 0.1 s after the tip was pressed ``depth_m`` into a wall at the start."""
        wall = rigid_plane(n.tolist(), float(n @ self.home))
        self.run.scene({"mapping": self.mapping, "walls": [wall]})
        return self._clamp(self.home - depth_m * n)[-100:]

    def force_errors_deg(self, depth_m: float) -> Vector:
        """Angle from the wall normal to the force on the clamp, for each of ``DIRECTIONS_RAD``."""
        return np.array([self._error_deg(normal(angle), depth_m) for angle in DIRECTIONS_RAD])

    def _error_deg(self, n: Vector, depth_m: float) -> float:
        force = -self.press(n, depth_m)["hand_force_n"].mean(axis=0)
        across = np.array([-n[2], 0.0, n[0]])
        return float(np.degrees(np.arctan2(across @ force, n @ force)))

    def _clamp(self, point: Vector) -> NDArray[Any]:
        self.run.hand({"type": "clamp", "position_m": point.tolist()})
        return self.run.run(0.6)
