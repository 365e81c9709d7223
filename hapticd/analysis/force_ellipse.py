"""Tip force of a two-joint linkage whose joint torques are bounded: as a ball, and as a box (KS §2.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]


def ball_force_n(jacobian: Matrix, torque_nm: float, direction_rad: Vector) -> Vector:
    """Largest tip force along each direction, (n,), for ‖τ‖₂ ≤ ``torque_nm``: f = τ/‖Jᵀu‖₂ (KS eq. 2)."""
    torques = _joint_torques(jacobian, direction_rad)
    found: Vector = torque_nm / np.hypot(torques[0], torques[1])
    return found


def box_force_n(jacobian: Matrix, torque_nm: float, direction_rad: Vector) -> Vector:
    """Largest tip force along each direction, (n,), for |τᵢ| ≤ ``torque_nm``: f = τ/‖Jᵀu‖_∞."""
    first, second = np.abs(_joint_torques(jacobian, direction_rad))
    found: Vector = torque_nm / np.maximum(first, second)
    return found


def smallest_ball_force_n(jacobian: Matrix, torque_nm: float) -> float:
    """Half the minor axis of the force ellipse, N: τ/σ_max(J)."""
    return float(torque_nm / np.linalg.norm(jacobian, 2))


def ellipse_n(jacobian: Matrix, torque_nm: float, points: int = 73) -> Matrix:
    """Points of the ellipse F = J⁻ᵀτ, ‖τ‖₂ = ``torque_nm``; (2, points), N (KS eq. 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi, points)
    torque = torque_nm * np.stack([np.cos(angle), np.sin(angle)])
    return np.asarray(np.linalg.solve(jacobian.T, torque), dtype=np.float64)


def _joint_torques(jacobian: Matrix, direction_rad: Vector) -> Matrix:
    """Torques of a unit force along each direction; (2, n)."""
    found: Matrix = jacobian.T @ np.stack([np.cos(direction_rad), np.sin(direction_rad)])
    return found
