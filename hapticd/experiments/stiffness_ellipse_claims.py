"""What WN say about the stiffness of the tip, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hapticd.analysis.stiffness import anisotropy, principal
from hapticd.experiments.claims import judged
from hapticd.experiments.experiment import Claim

TOLERANCE = 0.02
"""Share by which a stiffness on the twin may differ; its windings warm by a fraction of a kelvin."""


def claims(results: Mapping[str, Any]) -> tuple[Claim, ...]:
    """Every statement of WN §V about stiffness that a number can decide."""
    pose, workspace = results["pose"], results["workspace"]
    return (
        _locked(pose),
        _not_spherical(pose),
        _diagonal(pose),
        _scaled(pose),
        _within(pose),
        *_everywhere(workspace),
        _one_stiffness(pose, workspace),
        _equal_joints(results["unequal_joints"]),
    )


def _matrix(pose: Mapping[str, Any], name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array(pose[name])


def _per_mm(values: Any) -> str:
    return " and ".join(f"{value / 1e3:.2f}" for value in np.atleast_1d(values))


def _locked(pose: Mapping[str, Any]) -> Claim:
    expected, found = _matrix(pose, "k_inv_n_per_m"), _matrix(pose, "inverse_twin_n_per_m")
    error = float(np.linalg.norm(found - expected, 2) / np.linalg.norm(expected, 2))
    return judged(
        "With inverse mapping the tip has K_inv = J⁻ᵀ K_q J⁻¹",
        "WN eq. 21",
        f"{_per_mm(principal(expected)[0])} N/mm along its axes",
        f"{_per_mm(principal((found + found.T) / 2)[0])} N/mm on the twin, {100 * error:.1f} % off",
        holds=error < TOLERANCE,
    )


def _not_spherical(pose: Mapping[str, Any]) -> Claim:
    delta = np.radians(abs(pose["coupling_deg"]))
    expected = (1 + np.sin(delta)) / (1 - np.sin(delta))
    found = 1 + anisotropy(_matrix(pose, "inverse_twin_n_per_m"))
    return judged(
        "K_inv is not spherical",
        "WN §V, after eq. 22, Fig. 3",
        f"axes 1 : {expected:.2f} for equal links {pose['coupling_deg']:.0f}° off perpendicular",
        f"1 : {found:.2f} on the twin",
        holds=found > 1.1,
    )


def _diagonal(pose: Mapping[str, Any]) -> Claim:
    found = anisotropy(_matrix(pose, "transpose_twin_n_per_m"))
    return judged(
        "With transpose mapping K_trans collapses to a multiple of the identity",
        "WN eq. 27, Fig. 3",
        "axes 1 : 1",
        f"1 : {1 + found:.4f} on the twin",
        holds=found < 0.01,
    )


def _scaled(pose: Mapping[str, Any]) -> Claim:
    found = float(np.trace(_matrix(pose, "transpose_twin_n_per_m")) / 2)
    return judged(
        "K_trans is α K_θ",
        "WN eq. 27",
        f"{_per_mm(pose['k_c_n_per_m'])} N/mm, K_θ that of the joint",
        f"{_per_mm(found)} N/mm on the twin",
        holds=abs(found / pose["k_c_n_per_m"] - 1) < TOLERANCE,
    )


def _within(pose: Mapping[str, Any]) -> Claim:
    ball = np.linalg.svd(_matrix(pose, "transpose_twin_n_per_m"), compute_uv=False)[0]
    ellipse = np.linalg.svd(_matrix(pose, "inverse_twin_n_per_m"), compute_uv=False)[-1]
    return judged(
        "K_trans is nowhere stiffer than the softest direction of K_inv, at the pose",
        "WN eq. 28",
        "λ_max(K_trans) ≤ λ_min(K_inv)",
        f"{_per_mm(ball)} against {_per_mm(ellipse)} N/mm on the twin",
        holds=bool(ball <= (1 + TOLERANCE) * ellipse),
    )


def _everywhere(workspace: Mapping[str, Any]) -> tuple[Claim, Claim]:
    gain, (low, high) = workspace["loop_gain"][1], workspace["alpha_per_m2"]
    return (
        judged(
            "With α = λ_min[(J Jᵀ)⁻¹] no joint is stiffer than tuned, anywhere",
            "WN eq. 28, 29",
            "largest joint gain 1 of the tuned one",
            f"{gain:.6f} over {workspace['poses']} poses; α = {low:.1f}…{high:.1f} m⁻²",
            holds=gain < 1 + 1e-6,
        ),
        judged(
            "α is the largest allowed: any more makes a joint stiffer than tuned",
            "WN eq. 29",
            "joint gain of 1 reached at every pose",
            f"smallest {workspace['loop_gain'][0]:.6f}",
            holds=workspace["loop_gain"][0] > 1 - 1e-6,
        ),
    )


def _one_stiffness(pose: Mapping[str, Any], workspace: Mapping[str, Any]) -> Claim:
    expected = workspace["global_stiffness_n_per_m"]
    found = [
        float(np.trace(_matrix(pose, f"{name}_twin_n_per_m")) / 2)
        for name in ("workspace", "workspace_elsewhere")
    ]
    return judged(
        "The smallest α of the workspace gives one stiffness at all configurations",
        "WN §V, after eq. 29",
        f"{_per_mm(expected)} N/mm",
        f"{_per_mm(found)} N/mm at two poses of the twin",
        holds=bool(np.all(np.abs(np.array(found) / expected - 1) < TOLERANCE)),
    )


def _equal_joints(unequal: Mapping[str, float]) -> Claim:
    return judged(
        "All joints of the PHANTOM exhibit the same stiffness",
        "WN §V, before eq. 18",
        "1 : 1",
        f"1 : {unequal['stiffest_over_softest_joint']:.2f} by its ratios; one α for all joints "
        f"turns forces by up to {unequal['largest_error_deg']:.1f}°, K_q⁻¹ Jᵀ k_c in its place by none",
        holds=unequal["stiffest_over_softest_joint"] < 1 + TOLERANCE,
    )
