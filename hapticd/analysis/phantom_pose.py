"""A PHANTOM in one pose: Jacobian and joint stiffness, with the base free or locked."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.model import Model

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]

PLANE = (0, 2)
"""Coordinates x and z: the plane of the linkage with the base straight ahead."""

LINKS = (1, 2)
"""Joints that move in that plane."""


@dataclass(frozen=True, slots=True)
class PhantomPose:
    """J (3, 3) m/rad at ``q`` (3,) rad, K_q (3,) N·m/rad, tip (3,) m."""

    q: Vector
    tip: Vector
    jacobian: Matrix
    k_q: Vector

    @classmethod
    def of_model(cls, model: Model, q: Vector) -> PhantomPose:
        """The pose of a model whose windings are at their data-sheet temperature."""
        kinematics = _core.Kinematics(model.device_json)
        return cls(
            q, np.array(kinematics.forward(q)), np.array(kinematics.jacobian(q)), joint_stiffness(model)
        )

    @property
    def plane_jacobian(self) -> Matrix:
        """J of the linkage with its base locked straight ahead, (2, 2)."""
        return self.jacobian[np.ix_(PLANE, LINKS)]

    @property
    def plane_k_q(self) -> Vector:
        """K_q of the two joints that are left, (2,)."""
        return self.k_q[list(LINKS)]

    @property
    def coupling_rad(self) -> float:
        """δ = q3 − q2: the links are perpendicular where it is zero."""
        return float(self.q[2] - self.q[1])


def joint_stiffness(model: Model) -> Vector:
    """K_DC at the joints, ρ² k_T K_P/dR, (3,) N·m/rad, by the core."""
    drive = json.loads(model.device_json)["drive"]
    d_r = np.array(drive["r_25_ohm"]) - np.array(drive["r_hat_ohm"])
    return np.array(_core.SpringDrive(model.device_json).dc_stiffness(d_r))


def in_plane(angle_rad: float) -> Vector:
    """Unit vector at an angle in the plane of the linkage, from x towards z, (3,)."""
    return np.array([np.cos(angle_rad), 0.0, np.sin(angle_rad)])


def workspace(model: Model, steps: int) -> Iterator[PhantomPose]:
    """Poses within the joint limits, ``steps`` a joint. The base looks ahead: turning it is the same."""
    device = json.loads(model.device_json)
    low, high = device["joints"]["min_rad"], device["joints"]["max_rad"]
    kinematics = _core.Kinematics(model.device_json)
    for q2 in np.linspace(low[1], high[1], steps):
        for q3 in np.linspace(low[2], high[2], steps):
            q = np.array([0.0, q2, q3])
            if kinematics.inside(q, 0.0):
                yield PhantomPose.of_model(model, q)
