"""A hand that stirs inside a wall, on either device, while the scene is edited."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.flat_wall import flat_plane
from hapticd.twin import TwinRun

LAWS: Mapping[str, Mapping[str, Any]] = {
    "motion": {"type": "motion", "eta": 0.5},
    "spring": {"type": "spring", "stiffness_n_per_m": 900.0, "damping_n_s_per_m": 1.0},
    "damper": {"type": "damper", "damping_n_s_per_m": 15.0},
    "cubic_damper": {"type": "cubic_damper", "coefficient_n_s3_per_m3": 1.28e7, "form": "implicit"},
}
STIFFER: Mapping[str, Mapping[str, Any]] = {
    "motion": {"type": "motion", "eta": 0.0},
    "spring": {"type": "spring", "stiffness_n_per_m": 2700.0, "damping_n_s_per_m": 3.0},
    "damper": {"type": "damper", "damping_n_s_per_m": 45.0},
    "cubic_damper": {"type": "cubic_damper", "coefficient_n_s3_per_m3": 3.84e7, "form": "implicit"},
}
NEXT = {"motion": "spring", "spring": "damper", "damper": "cubic_damper", "cubic_damper": "motion"}

AXIS = {"phantom-1.0": 2, "hhd": 1}
DEPTH_M = {"phantom-1.0": 0.004, "hhd": 0.012}
AMPLITUDE_M = {"phantom-1.0": 0.003, "hhd": 0.02}
"""The HHD's bearings hold what its hand does with less."""

STEP_MAX_N = {"phantom-1.0": 4.0, "hhd": 60.0}
"""The slew limit of the motors a tick at 1 kHz."""

BRAKE_STEP_N = {"phantom-1.0": 0.0, "hhd": 5.0}
"""What brakes add in a tick: they rise by 2 N·m at most, through a lag of 50 ms, and turn with the motion."""

FREQUENCY_HZ = 3.0
WALL, OTHER = 11, 12
"""Keys of the wall that is edited, and of one that comes beside it."""


class StirredWall:
    """An enabled device whose hand swings across a point behind a plane, without ever coming out of it."""

    def __init__(self, model: str, law: str, *, passivity: bool, brake: bool) -> None:
        self.model = model
        self.law = law
        self._switches = {"passivity": passivity, "brake": brake}
        self._twin = TwinRun(model)
        self._tip = self._twin.truth()["tip_position_m"]
        self._up = np.eye(3)[AXIS[model]]
        self._surface_m = float(self._up @ self._tip) + DEPTH_M[model]

    def wall(
        self, *, law: Mapping[str, Any] | None = None, moved_m: float = 0.0, key: int = WALL
    ) -> dict[str, Any]:
        """The wall, with another law or at another place."""
        law = LAWS[self.law] if law is None else law
        return flat_plane(self._up.tolist(), self._surface_m + moved_m, law, key=key, **self._switches)

    def around(self) -> dict[str, Any]:
        """A second wall, across the first, that contains the tip."""
        across = np.eye(3)[0]
        surface_m = float(across @ self._tip) + DEPTH_M[self.model]
        return flat_plane(across.tolist(), surface_m, LAWS[self.law], key=OTHER, **self._switches)

    def body(self, shape: str, *, hollow: bool, moved_m: float = 0.0) -> dict[str, Any]:
        """The wall as a sphere, box or capsule that the hand stirs in without coming out of it."""
        center = (self._tip + moved_m * self._up).tolist()
        reach_m = 3.0 * DEPTH_M[self.model]
        across = reach_m * np.eye(3)[0]
        shapes: dict[str, dict[str, Any]] = {
            "sphere": {"center_m": center, "radius_m": reach_m},
            "box": {"center_m": center, "axes": np.eye(3).tolist(), "half_m": [reach_m] * 3},
            "capsule": {
                "from_m": (center - across).tolist(),
                "to_m": (center + across).tolist(),
                "radius_m": reach_m,
            },
        }
        return {**self.wall(), "shape": {"type": shape, "hollow": hollow, **shapes[shape]}}

    def stir(self, before: Mapping[str, Any], after: Mapping[str, Any], fade_s: float) -> NDArray[Any]:
        """Records of the half second after ``before`` is replaced by ``after``, and of ten ticks before."""
        self._twin.scene(before)
        self._twin.enable()
        self._twin.hand(
            {
                "type": "stroke",
                "center_m": self._tip.tolist(),
                "axis": self._up.tolist(),
                "amplitude_m": AMPLITUDE_M[self.model],
                "frequency_hz": FREQUENCY_HZ,
            }
        )
        lived = self._twin.run(0.4)
        self._twin.scene({**after, "fade_s": fade_s})
        return np.concatenate([lived[-10:], self._twin.run(0.5)])


def largest_step_n(records: NDArray[Any]) -> float:
    """Largest change of the tip force from one tick to the next, by the actuator model."""
    return float(np.linalg.norm(np.diff(records["tip_force_n"], axis=0), axis=1).max())


def step_max_n(model: str) -> float:
    """Largest change of the tip force a tick that the limits let through."""
    return (STEP_MAX_N[model] + BRAKE_STEP_N[model]) * 1.001


def force_n(records: NDArray[Any]) -> NDArray[Any]:
    """Size of the force of motors and brakes, (ticks,)."""
    return np.asarray(np.linalg.norm(records["tip_force_n"], axis=1))
