"""Stiffness at the tip (WN §V, physics §3)."""

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def locked_joints(jacobian: Vector, k_q: Vector) -> Vector:
    """K_x = J⁻ᵀ K_q J⁻¹ (WN eq. 21), N/m."""
    inverse = np.linalg.inv(jacobian)
    return inverse.T @ np.diag(k_q) @ inverse


def isotropic_bound(jacobian: Vector, k_q: Vector) -> float:
    """λ_min of the locked joints' stiffness (WN eq. 28), N/m."""
    return float(np.linalg.eigvalsh(locked_joints(jacobian, k_q)).min())


def direction_error_rad(psi_rad: Vector, delta_rad: float) -> Vector:
    """Error of the force direction with inverse mapping, equal links and joints, wall normal at ψ
    from the soft principal axis, δ = q3 − q2 (physics §3.2)."""
    kappa = (1 + abs(np.sin(delta_rad))) / (1 - abs(np.sin(delta_rad)))
    sin, cos = np.sin(psi_rad), np.cos(psi_rad)
    error: Vector = np.arctan2((kappa - 1) * sin * cos, cos**2 + kappa * sin**2)
    return error
