"""Pressing a soft wall on the twin and letting go, with three sets of actuators."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.run import Run
from hapticd.flat_wall import flat_plane

Vector = NDArray[np.float64]

MODEL = "hhd"

ONE_OF_EACH: Mapping[str, Any] = {
    "brakes.torque_max_nm": [1e-3, 10.0, 0.0],
    "twin.motor.torque_scale": [1.0, 1e-9, 1.0],
}
"""Joint 1 has its motor alone, joint 2 its brake alone (KS Fig. 5)."""

CASES: Mapping[str, tuple[Mapping[str, Any], str]] = {
    "one_of_each": (ONE_OF_EACH, "motor_and_brake"),
    "motors": ({}, "motor_only"),
    "motors_and_brakes": ({}, "motor_and_brake"),
}
"""Overrides of the twin, and the scene's allocation."""

MOVING_M_PER_S = 0.05
"""Faster than this the tip leaves the wall."""

DEEP_M = 1e-3
"""Depth from which on the direction of the force is judged."""

STEADY_S = 0.3
START_M = 0.02


@dataclass(frozen=True)
class Press:
    """Records of pressing and of letting go."""

    compression: NDArray[Any]
    release: NDArray[Any]

    @property
    def held_deg(self) -> float:
        """Largest angle of the force to the normal while the wall is held pressed."""
        steady = self.compression["t_mono_ns"] > self.compression["t_mono_ns"][-1] - STEADY_S * 1e9
        return float(off_normal_deg(self.compression[steady]).max())

    @property
    def leaving(self) -> NDArray[Any]:
        """The ticks in which the tip moves out of the wall."""
        outwards = self.release["tip_velocity_m_per_s"][:, 1] < -MOVING_M_PER_S
        return self.release[outwards & (self.release["contact_depth_m"] > DEEP_M)]

    def numbers(self) -> dict[str, float]:
        """Angles to the normal, degrees."""
        angles = off_normal_deg(self.leaving)
        return {
            "compression_max_deg": self.held_deg,
            "release_max_deg": float(angles.max()),
            "release_median_deg": float(np.median(angles)),
            "brake_held_nm": float(np.abs(self.compression["brake_torque_nm"][-1]).max()),
        }

    def trace(self) -> dict[str, Vector]:
        """Both parts as one table."""
        records = np.concatenate([self.compression, self.release])
        return {
            "t_s": (records["t_mono_ns"] - records["t_mono_ns"][0]) * 1e-9,
            "depth_m": records["contact_depth_m"],
            "force_x_n": -records["hand_force_n"][:, 0],
            "force_y_n": -records["hand_force_n"][:, 1],
            "off_normal_deg": off_normal_deg(records),
        }


def off_normal_deg(records: NDArray[Any]) -> Vector:
    """Angle between the force on the hand and the wall's normal −y, degrees."""
    force = -records["hand_force_n"]
    found: Vector = np.degrees(np.abs(np.arctan2(force[:, 0], -force[:, 1])))
    return found


def pressed(run: Run, case: str) -> Press:
    """Carries the tip into the wall by a clamp and out again."""
    overrides, allocation = CASES[case]
    x, y, depth = run.number("x_m"), run.number("y_m"), run.number("depth_m")
    twin = run.twin(MODEL, overrides=overrides)
    law = {"type": "spring", "stiffness_n_per_m": run.number("stiffness_n_per_m"), "damping_n_s_per_m": 0.0}
    twin.scene({"walls": [flat_plane([0.0, -1.0, 0.0], -y, law)], "allocation": allocation})
    twin.enable()
    twin.hand({"type": "clamp", "position_m": [x, y - START_M, 0.0]})
    twin.run(1.5)
    twin.hand({"type": "clamp", "position_m": [x, y + depth, 0.0]})
    compression = twin.run(run.number("press_s"))
    twin.hand({"type": "clamp", "position_m": [x, y - 0.25 * depth, 0.0]})
    return Press(compression, twin.run(run.number("press_s")))
