"""How far the transpose mapping keeps the force on its direction when the tip moves fast (WN §V, end)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.phantom_pose import LINKS, PhantomPose, in_plane
from hapticd.analysis.spring_drive import SpringDrive
from hapticd.analysis.stiffness import locked_joints
from hapticd.experiments.drive_tuning import MODEL, tuned
from hapticd.experiments.plane_wall import pinned
from hapticd.experiments.run import Run
from hapticd.experiments.shaker import CLEAN, Answer, Shake, shaken
from hapticd.experiments.stiffness_probe import PLANE_AXES

Vector = NDArray[np.float64]

AMPLITUDE_M = 1e-4


@dataclass(frozen=True)
class Bandwidth:
    """Error of direction (n,), rad, by frequency: twin and closed form; ``locked_rad`` is that of K_inv."""

    frequency_hz: Vector
    error_rad: Vector
    expected_rad: Vector
    locked_rad: Vector

    def largest_below_deg(self, frequency_hz: float) -> float:
        """Largest error up to a frequency, °."""
        return float(np.degrees(self.error_rad[self.frequency_hz <= frequency_hz].max(initial=0.0)))

    def numbers(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "frequency_hz": self.frequency_hz.tolist(),
            "error_deg": np.degrees(self.error_rad).tolist(),
            "closed_form_deg": np.degrees(self.expected_rad).tolist(),
            "locked_joints_deg": np.degrees(self.locked_rad).tolist(),
        }

    def trace(self) -> dict[str, Vector]:
        """As a table."""
        return {
            "frequency_hz": self.frequency_hz,
            "error_rad": self.error_rad,
            "closed_form_rad": self.expected_rad,
            "locked_joints_rad": self.locked_rad,
        }


def bandwidth(run: Run, pose: PhantomPose, frequency_hz: Vector, rate_hz: float) -> Bandwidth:
    """Shakes the tip where K_inv errs most, about a pinned set-point, under transpose mapping."""
    axis = in_plane(worst_direction_rad(pose))
    scene = {"mapping": "transpose", "walls": pinned(pose.tip, PLANE_AXES)}

    def shake(frequency: float) -> tuple[float, float, float]:
        order = Shake(pose.q, axis, AMPLITUDE_M, frequency, rate_hz, scene)
        return _errors(run, pose, order, shaken(run, order, {**CLEAN, **tuned(run)}))

    found = np.array(run.map(shake, [float(f) for f in frequency_hz], doing="shaking", until=0.95))
    return Bandwidth(frequency_hz, *found.T)


def worst_direction_rad(pose: PhantomPose) -> float:
    """Where locked joints turn the force most: tan ψ = κ^−½ from the soft axis."""
    values, axes = np.linalg.eigh(locked_joints(pose.plane_jacobian, pose.plane_k_q))
    soft_rad = np.arctan2(axes[1, 0], axes[0, 0])
    return float(soft_rad + np.arctan(np.sqrt(values[0] / values[1])))


def _errors(run: Run, pose: PhantomPose, shake: Shake, answer: Answer) -> tuple[float, float, float]:
    """Error on the twin, in closed form, and of locked joints, for the motion there really was."""
    model = run.model(MODEL, tuned(run))
    device: Mapping[str, Any] = json.loads(model.device_json)["drive"]
    links = list(LINKS)
    jacobian = pose.plane_jacobian
    motion = jacobian @ answer.joint_rad[links]
    torque_nm = (np.array(device["ratio"]) * np.array(device["k_t_nm_per_a"]) * answer.current_a)[links]
    force = np.linalg.solve(jacobian.T, torque_nm)
    own, shared = _parts(run, pose, shake)
    inverse = np.linalg.inv(jacobian)
    stiffness = inverse.T @ np.diag(own) @ inverse + shared * np.eye(2)
    locked = locked_joints(jacobian, pose.plane_k_q)
    return _angle(motion, force), _angle(motion, stiffness @ motion), _angle(motion, locked @ motion)


def _parts(run: Run, pose: PhantomPose, shake: Shake) -> tuple[NDArray[np.complex128], complex]:
    """What each joint resists by itself, N·m/rad, and what the law adds in every direction alike, N/m.

    With q_Sd of WN eq. 23 and 24 a joint drive gives k_T (θ̇ − θ̇_f) to its own motion, θ̇_f filtered, and
    K_P + (k_T + K_D) s λ/(s+λ) to the share K_q⁻¹ Jᵀ k_c of the tip's.
    """
    model, frequency = run.model(MODEL, tuned(run)), np.array([shake.frequency_hz])
    device, twin = json.loads(model.device_json), json.loads(model.twin_json)
    delay_ticks, period_s = 1 + twin["command_delay_ticks"], 1.0 / shake.rate_hz
    ratio = np.array(device["drive"]["ratio"])
    drives = [SpringDrive.of_model(model, axis) for axis in LINKS]
    own = [drive.sampled_free_space(frequency, period_s, delay_ticks)[0] for drive in drives]
    first = replace(drives[0], k_d=drives[0].k_d + drives[0].k_t)
    shared = first.sampled_feedback(frequency, period_s, delay_ticks)[0] / first.k_dc
    return ratio[list(LINKS)] ** 2 * np.array(own), complex(
        shared * _core.isotropic_stiffness(pose.jacobian, pose.k_q)
    )


def _angle(motion: NDArray[np.complex128], force: NDArray[np.complex128]) -> float:
    """Angle between complex amplitudes in a plane: 0 where the force is along the motion, in phase or not."""
    along = np.vdot(motion, force)
    across = motion[0] * force[1] - motion[1] * force[0]
    return float(np.arctan2(np.abs(across), np.abs(along)))
