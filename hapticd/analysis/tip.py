"""What a device is at its tip: mass, friction, resolution. Lower bounds, from the model and its twin."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.model import Model

Matrix = NDArray[np.float64]

POSES_PER_JOINT = 15
"""Steps of the search over the workspace: 11° or less, within 2 % of the extremes."""


@dataclass(frozen=True, slots=True)
class Tip:
    """The tip in its least favourable direction. Zero where the model does not say.

    ``mass_kg``: apparent mass, 1/λ_max(J M⁻¹ Jᵀ), M from ``[twin.linkage]`` and the rotors.
    ``viscous_n_s_per_m``: λ_min(J⁻ᵀ b J⁻¹), b from ``twin.friction.viscous_nm_s_per_rad``.
    ``coulomb_n``: min over directions of Σ f_i |q̇_i| per tip speed, which is min f_i/|J e_i|; f from
    ``twin.friction.coulomb_nm`` and the drag of the brakes, ``brakes.drag_nm``.
    ``quantum_m``: max |J e_i| over one count, from ``joints.counts_per_rad``.
    """

    mass_kg: float
    viscous_n_s_per_m: float
    coulomb_n: float
    quantum_m: float


def tip_at(model: Model, q: Sequence[float]) -> Tip:
    """The tip at joint angles ``q``, (3,) rad. ``ValueError`` at a singularity."""
    device, twin = json.loads(model.device_json), json.loads(model.twin_json)
    jacobian = _jacobian(model, q)
    columns = np.linalg.norm(jacobian, axis=0)
    counts = np.abs(np.array(device["joints"]["counts_per_rad"][: model.dof]))
    return Tip(
        mass_kg=_mass_kg(model, q, jacobian) if twin else 0.0,
        viscous_n_s_per_m=_viscous(_joint(twin, "viscous_nm_s_per_rad", model.dof), jacobian),
        coulomb_n=float(np.min((_joint(twin, "coulomb_nm", model.dof) + _drag(device, model.dof)) / columns)),
        quantum_m=float(np.max(columns / counts)),
    )


@lru_cache(maxsize=64)
def worst_tip(model: Model) -> Tip:
    """The least favourable of every value over the workspace; they need not belong to one pose."""
    tips = [tip_at(model, q) for q in poses(model)]
    return Tip(
        mass_kg=min(tip.mass_kg for tip in tips),
        viscous_n_s_per_m=min(tip.viscous_n_s_per_m for tip in tips),
        coulomb_n=min(tip.coulomb_n for tip in tips),
        quantum_m=max(tip.quantum_m for tip in tips),
    )


def poses(model: Model) -> Iterator[list[float]]:
    """Poses all over the workspace, (3,) rad, clear of singularities; the base of a PHANTOM stays ahead."""
    device = json.loads(model.device_json)
    kinematics, joints = _core.Kinematics(model.device_json), device["joints"]
    first = model.dof - 2  # a third joint turns the whole device, which changes nothing at the tip
    ranges = [
        np.linspace(joints["min_rad"][axis], joints["max_rad"][axis], POSES_PER_JOINT)
        for axis in (first, first + 1)
    ]
    for one, other in ((one, other) for one in ranges[0] for other in ranges[1]):
        q = [0.0] * first + [float(one), float(other)] + [0.0] * (1 - first)
        clear = kinematics.singularity_margin(q) >= device["limits"]["singularity_margin"]
        if clear and kinematics.inside(q, 0.0):
            yield q


def _jacobian(model: Model, q: Sequence[float]) -> Matrix:
    kinematics = _core.Kinematics(model.device_json)
    if kinematics.jacobian_inverse(q) is None:
        raise ValueError(f"{model.name} is singular at {list(q)}.")
    return np.array(kinematics.jacobian(q))[: model.dof, : model.dof]


def _mass_kg(model: Model, q: Sequence[float], jacobian: Matrix) -> float:
    inertia = np.array(_core.mass_matrix(model.device_json, model.twin_json, q))[: model.dof, : model.dof]
    mobility = jacobian @ np.linalg.solve(inertia, jacobian.T)
    return float(1.0 / np.linalg.eigvalsh(mobility)[-1])


def _viscous(joint: Matrix, jacobian: Matrix) -> float:
    inverse = np.linalg.inv(jacobian)
    return float(np.linalg.eigvalsh(inverse.T @ np.diag(joint) @ inverse)[0])


def _joint(twin: dict[str, Any] | None, name: str, dof: int) -> Matrix:
    return np.array(twin["friction"][name][:dof]) if twin else np.zeros(dof)


def _drag(device: dict[str, Any], dof: int) -> Matrix:
    brakes = device.get("brakes")
    return np.array(brakes["drag_nm"][:dof]) if brakes else np.zeros(dof)
