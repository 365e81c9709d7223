"""The stiffness of a PHANTOM's tip in the plane of its linkage, measured on the twin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.phantom_pose import PLANE, in_plane
from hapticd.experiments.clamped_phantom import ClampedPhantom
from hapticd.experiments.drive_tuning import tuned
from hapticd.experiments.plane_wall import pinned
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]

SETTLE_S = 0.06
MEASURE_S = 0.02
"""The current is there after 10 ms, and in a tenth of a second more it would warm the windings."""

PLANE_AXES = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class Probe:
    """Displacements from the set-point, m, and forces on the sensor, N, each (n, 2): x and z."""

    displacement_m: Matrix
    force_n: Matrix

    @property
    def stiffness(self) -> Matrix:
        """K of force = weight − K · displacement by least squares, (2, 2), N/m."""
        moves = np.column_stack([self.displacement_m, np.ones(len(self.displacement_m))])
        fitted = np.linalg.lstsq(moves, -self.force_n, rcond=None)[0]
        found: Matrix = np.array(fitted[:2].T, dtype=np.float64)
        return found


def probe(run: Run, pose_rad: Vector, scene: Mapping[str, Any]) -> Probe:
    """Pins the set-point where the tip is and pulls the tip away in every direction, each time anew."""
    directions = np.arange(run.integer("directions")) * 2 * np.pi / run.integer("directions")

    def pull(angle_rad: float) -> tuple[Vector, Vector]:
        phantom = ClampedPhantom(run, pose_rad, tuned(run))
        walls = pinned(phantom.home, PLANE_AXES)
        phantom.move(run.number("displacement_m") * in_plane(angle_rad))
        tip, force = phantom.measure({**scene, "walls": walls}, SETTLE_S, MEASURE_S)
        return (tip - phantom.home)[list(PLANE)], force[list(PLANE)]

    pulled = run.map(pull, [float(angle) for angle in directions], doing="pulling", until=0.9)
    return Probe(*(np.array(column) for column in zip(*pulled, strict=True)))
