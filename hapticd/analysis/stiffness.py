"""Stiffness of the tip from the stiffness of the joints (WN §V)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]


def locked_joints(jacobian: Matrix, k_q: Vector) -> Matrix:
    """K_inv = J⁻ᵀ K_q J⁻¹, (n, n), N/m, for joints of ``k_q`` N·m/rad (WN eq. 21)."""
    inverse = np.linalg.inv(jacobian)
    found: Matrix = inverse.T @ np.diag(k_q) @ inverse
    return found


def transposed(jacobian: Matrix, k_q: Vector, gain: Vector) -> Matrix:
    """K = J⁻ᵀ K_q A Jᵀ of q_Sd = q + A Jᵀ (x_Sd − x), A diagonal with entries ``gain`` (WN eq. 26)."""
    found: Matrix = np.linalg.inv(jacobian).T @ np.diag(k_q * gain) @ jacobian.T
    return found


def alpha_bound(jacobian: Matrix) -> float:
    """Largest α, 1/m², for equal joints: λ_min[(J Jᵀ)⁻¹] = 1/σ_max(J)² (WN eq. 29)."""
    return float(np.linalg.norm(jacobian, 2) ** -2)


def principal(stiffness: Matrix) -> tuple[Vector, Matrix]:
    """Stiffness along the principal axes of a symmetric matrix, rising, and the axes as columns."""
    values, axes = np.linalg.eigh(stiffness)
    return values, axes


def anisotropy(stiffness: Matrix) -> float:
    """Largest over smallest singular value, less one; 0 for a sphere."""
    values = np.linalg.svd(stiffness, compute_uv=False)
    return float(values[0] / values[-1] - 1.0)


def direction_error_rad(stiffness: Matrix, direction_rad: Vector) -> Vector:
    """Angle from a displacement to its force, for displacements at angles in a plane; (n,) rad.

    ``stiffness`` is (2, 2); counter-clockwise is positive.
    """
    along = np.stack([np.cos(direction_rad), np.sin(direction_rad)])
    across = np.stack([-np.sin(direction_rad), np.cos(direction_rad)])
    force = stiffness @ along
    found: Vector = np.arctan2(np.sum(across * force, axis=0), np.sum(along * force, axis=0))
    return found


def largest_direction_error_rad(stiffness: Matrix) -> float:
    """asin((κ−1)/(κ+1)) of a symmetric stiffness with eigenvalue ratio κ."""
    values, _ = principal(stiffness)
    return float(np.arcsin((values[-1] - values[0]) / (values[-1] + values[0])))
