"""How stiff a device's tip is at a pose: by inverse and by transpose mapping (WN Fig. 3)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from hapticd import _core
from hapticd.analysis.device_loop import device_loop
from hapticd.analysis.stiffness import alpha_bound, locked_joints, principal
from hapticd.model import Model
from hapticd.snapshot import Report

CHECK_RATE_HZ = 1000.0
"""Stiffness does not depend on the rate; the loop's facts ask for one."""


class Axis(Report):
    """One principal axis of a stiffness: its N/m and its unit direction."""

    stiffness_n_per_m: float
    direction: list[float]


class TipStiffness(Report):
    """Stiffness at the tip in one pose.

    ``inverse`` are the principal axes of K_inv = J⁻ᵀ K_q J⁻¹ (WN eq. 21), softest first; null for motors
    behind a virtual coupling, whose joints have no stiffness of their own. ``transpose_n_per_m`` is the ball
    of the transpose mapping, k_c (WN eq. 29); ``workspace_n_per_m`` the smallest over the workspace.
    ``alpha_per_m2`` is α = 1/σ_max(J)².
    """

    q_rad: list[float]
    tip_position_m: list[float]
    inverse: list[Axis] | None
    transpose_n_per_m: float
    workspace_n_per_m: float
    alpha_per_m2: float
    singularity_margin: float


def tip_stiffness(model: Model, q: Sequence[float]) -> TipStiffness:
    """The stiffness at joint angles ``q``, (3,) rad. ``ValueError`` at a singularity."""
    kinematics = _core.Kinematics(model.device_json)
    if kinematics.jacobian_inverse(q) is None:
        raise ValueError("The device is singular in this pose.")
    jacobian = np.array(kinematics.jacobian(q))[: model.dof, : model.dof]
    device = json.loads(model.device_json)
    coupling, inverse, workspace = device_loop(model, CHECK_RATE_HZ, q=q).coupling, None, None
    if coupling.is_spring_drive:
        k_q = _joint_stiffness(device["drive"])
        values, axes = principal(locked_joints(jacobian, k_q))
        pairs = zip(values.tolist(), axes.T.tolist(), strict=True)
        inverse = [Axis(stiffness_n_per_m=value, direction=axis) for value, axis in pairs]
        workspace = kinematics.workspace_stiffness(k_q.tolist())
    return TipStiffness(
        q_rad=list(q)[: model.dof],
        tip_position_m=list(kinematics.forward(q))[: model.dof],
        inverse=inverse,
        transpose_n_per_m=coupling.stiffness_n_per_m,
        workspace_n_per_m=coupling.stiffness_n_per_m if workspace is None else workspace,
        alpha_per_m2=alpha_bound(jacobian),
        singularity_margin=kinematics.singularity_margin(q),
    )


def _joint_stiffness(drive: dict[str, Any]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """K_q = ρ² k_T K_P/dR (WN eq. 13), N·m/rad."""
    d_r = np.array(drive["r_25_ohm"]) - np.array(drive["r_hat_ohm"])
    motor = np.array(drive["k_t_nm_per_a"]) * np.array(drive["k_p_v_per_rad"]) / d_r
    stiffness: np.ndarray[Any, np.dtype[np.float64]] = np.array(drive["ratio"]) ** 2 * motor
    return stiffness
