"""A shaker at the tip of a PHANTOM twin: one sine, and what the motors answer at its frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.phasor import phasor
from hapticd.experiments.run import Run

Vector = NDArray[np.float64]
Phasors = NDArray[np.complex128]

MODEL = "phantom-1.0"

SHAKER: Mapping[str, Any] = {
    "twin.hand.mass_kg": 0.05,
    "twin.hand.grip_stiffness_n_per_m": 2e5,
    "twin.hand.grip_damping_n_s_per_m": 50.0,
    "twin.hand.arm_stiffness_n_per_m": 2e5,
    "twin.hand.arm_damping_n_s_per_m": 50.0,
    "twin.hand.arm_force_max_n": 1e4,
}
"""A hand as stiff as a machine. It need not follow its sine: torque is held against the angle there is."""

CLEAN: Mapping[str, Any] = {
    "joints.counts_per_rad": [4e9, 4e9, 4e9],
    "twin.winding.brush_ripple": 0.0,
    "twin.friction.coulomb_nm": [0.0, 0.0, 0.0],
}
"""Encoders that resolve a nanometre, and no ripple: at high frequencies the tip moves less than a count."""

STEP_S = 2e-5
STEP_PERIODS = 0.005
"""Longest step of the plant, in seconds and in periods: its torque answers a step late, 2° at most."""

SETTLE_S = 0.9
"""Ramp of the outputs and growth of the stroke, then 0.4 s for the rest to die away."""

PERIODS = 2.0
"""Periods measured at least."""

WINDOW_S = 0.15
"""Time measured at least, s."""


@dataclass(frozen=True)
class Shake:
    """A sine along the unit vector ``axis`` about the tip's place in ``pose_rad``, and the scene it meets."""

    pose_rad: Vector
    axis: Vector
    amplitude_m: float
    frequency_hz: float
    rate_hz: float
    scene: Mapping[str, Any]


@dataclass(frozen=True)
class Answer:
    """Complex amplitudes at the shaker's frequency: joint angles rad, motor currents A.

    ``limits`` has the bits of the limits that acted; without any the answer is linear.
    """

    joint_rad: Phasors
    current_a: Phasors
    limits: int


def shaken(run: Run, shake: Shake, overrides: Mapping[str, Any]) -> Answer:
    """Shakes a new twin until it is steady, and measures by its encoders and currents."""
    twin = run.twin(MODEL, rate_hz=shake.rate_hz, overrides=_overrides(shake, overrides))
    twin.scene(shake.scene)
    twin.enable()
    stroke = {"type": "stroke", "amplitude_m": shake.amplitude_m, "frequency_hz": shake.frequency_hz}
    center = twin.truth()["tip_position_m"].tolist()
    twin.hand({**stroke, "center_m": center, "axis": shake.axis.tolist()})
    twin.run(SETTLE_S)
    records = twin.run(max(PERIODS / shake.frequency_hz, WINDOW_S))
    time_s = np.arange(len(records)) / shake.rate_hz
    return Answer(
        phasor(time_s, records["joint_position_rad"], shake.frequency_hz),
        phasor(time_s, records["motor_current_a"], shake.frequency_hz),
        int(np.bitwise_or.reduce(records["limits"])),
    )


def _overrides(shake: Shake, overrides: Mapping[str, Any]) -> dict[str, Any]:
    step_s = min(STEP_S, STEP_PERIODS / shake.frequency_hz)
    substeps = int(np.ceil(1.0 / (shake.rate_hz * step_s)))
    return {
        **SHAKER,
        "joints.home_rad": shake.pose_rad.tolist(),
        "twin.substeps": substeps,
        **overrides,
    }
