"""A PHANTOM twin whose tip is fixed to a force sensor on a bench clamp: the set-up of WN Fig. 4."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.drive_tuning import MODEL
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]

IDEAL: Mapping[str, Any] = {
    "twin.winding.brush_ripple": 0.0,
    "twin.friction.coulomb_nm": [0.0, 0.0, 0.0],
}
"""Motors and bearings without what hides the law: brush ripple moves a joint's stiffness, friction holds
part of the force."""


ENABLE_S = 0.4
"""Time in which the outputs ramp up."""

CLAMP_S = 1.0
"""Time in which the clamp takes the tip to a point."""


class ClampedPhantom:
    """Enabled, and held by the clamp where it started."""

    def __init__(self, run: Run, pose_rad: Vector, overrides: Mapping[str, Any]) -> None:
        self.twin = run.twin(MODEL, overrides={**overrides, "joints.home_rad": pose_rad.tolist()})
        self.home: Vector = self.twin.truth()["tip_position_m"]
        self.twin.enable()
        self._hold(self.home)
        self.twin.run(ENABLE_S)

    def move(self, displacement: Vector) -> None:
        """Has the clamp take the tip to ``displacement``, m, from where it started, and settle there."""
        self._hold(self.home + displacement)
        self.twin.run(CLAMP_S)

    def measure(self, scene: Mapping[str, Any], settle_s: float, duration_s: float) -> tuple[Vector, Vector]:
        """Mean tip position by the encoders, m, and what the scene adds to the force on the sensor, N.

        The sensor is tared without the scene: what is left of the linkage's weight is no stiffness.
        """
        tare = self.twin.run(duration_s)["hand_force_n"].mean(axis=0)
        self.twin.scene(scene)
        self.twin.run(settle_s)
        records = self.twin.run(duration_s)
        return records["tip_position_m"].mean(axis=0), tare - records["hand_force_n"].mean(axis=0)

    def _hold(self, point: Vector) -> None:
        self.twin.hand({"type": "clamp", "position_m": point.tolist()})
