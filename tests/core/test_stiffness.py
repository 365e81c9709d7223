"""Mappings and stiffness bounds of the core against the eigenvalues of numpy."""

import numpy as np
import pytest

from hapticd._core import Kinematics, isotropic_stiffness, lambda_max_sym
from tests.oracle import stiffness
from tests.oracle.devices import HHD, PHANTOM, device_json, poses

DELTA_RAD = np.radians(30.0)


def test_largest_eigenvalue_agrees_with_lapack() -> None:
    rng = np.random.default_rng(1)
    for _ in range(500):
        a = rng.normal(size=(3, 3)) * 10.0 ** rng.uniform(-4, 4)
        symmetric = a @ a.T
        assert lambda_max_sym(symmetric) == pytest.approx(np.linalg.eigvalsh(symmetric).max(), rel=1e-7)


def test_bound_is_the_softest_direction_of_the_locked_phantom() -> None:
    core, rng = Kinematics(device_json(PHANTOM)), np.random.default_rng(2)
    for q in poses(PHANTOM, 300, seed=2):
        if core.singularity_margin(q) > 0.05:
            k_q, jacobian = rng.uniform(20, 200, 3), np.array(core.jacobian(q))
            expected = stiffness.isotropic_bound(jacobian, k_q)
            assert isotropic_stiffness(jacobian, k_q) == pytest.approx(expected, rel=1e-6)


def test_bound_is_the_softest_direction_of_the_locked_rhombus() -> None:
    core, rng = Kinematics(device_json(HHD)), np.random.default_rng(3)
    for q in poses(HHD, 300, seed=3):
        k_q, jacobian = rng.uniform(20, 200, 2), np.array(core.jacobian(q))
        expected = stiffness.isotropic_bound(jacobian[:2, :2], k_q)
        assert isotropic_stiffness(jacobian, (*k_q, 0)) == pytest.approx(expected, rel=1e-6)


def test_equal_joints_give_the_bound_of_the_paper() -> None:
    """α = λ_min[(JJᵀ)⁻¹] (WN eq. 29) with k_c = α K."""
    core = Kinematics(device_json(PHANTOM))
    for q in poses(PHANTOM, 100, seed=4):
        jacobian = np.array(core.jacobian(q))
        alpha = 1 / np.linalg.norm(jacobian, ord=2) ** 2
        assert isotropic_stiffness(jacobian, (100, 100, 100)) == pytest.approx(100 * alpha, rel=1e-7)


@pytest.mark.parametrize("name", [PHANTOM, HHD])
def test_workspace_stiffness_is_below_every_sampled_pose(name: str) -> None:
    core = Kinematics(device_json(name))
    k_q = (120.0, 100.0, 100.0) if name == PHANTOM else (120.0, 100.0, 0.0)
    bounds = [isotropic_stiffness(core.jacobian(q), k_q) for q in poses(name, 4000, seed=5)]
    everywhere = core.workspace_stiffness(k_q)
    assert everywhere <= min(bounds) * 1.001
    assert everywhere >= min(bounds) * 0.9


def test_transpose_mapping_pushes_along_the_wall_normal() -> None:
    """The static force of a push, K_q (q_Sd − q) carried to the tip, for 24 directions."""
    core = Kinematics(device_json(PHANTOM))
    q, k_q = np.array([0.0, 0.0, DELTA_RAD]), np.array([120.0, 100.0, 100.0])
    for normal in planar_normals():
        force = static_force(core, "transpose", q, normal, k_q)
        assert force / np.linalg.norm(force) == pytest.approx(normal, abs=1e-9)


def test_inverse_mapping_misses_the_wall_normal_by_the_closed_form() -> None:
    core = Kinematics(device_json(PHANTOM))
    q, k_q = np.array([0.0, 0.0, DELTA_RAD]), np.full(3, 100.0)
    locked = stiffness.locked_joints(np.array(core.jacobian(q)), k_q)[np.ix_([0, 2], [0, 2])]
    soft_axis = np.linalg.eigh(locked)[1][:, 0]
    found, expected = [], []
    for normal in planar_normals():
        force = static_force(core, "inverse", q, normal, k_q)
        found.append(signed_angle(normal[[0, 2]], force[[0, 2]]))
        expected.append(signed_angle(soft_axis, normal[[0, 2]]))
    errors = stiffness.direction_error_rad(np.array(expected), DELTA_RAD)
    assert np.allclose(found, errors, rtol=0, atol=np.radians(0.1))
    assert np.degrees(np.abs(errors).max()) == pytest.approx(30.0, abs=0.5)


def test_unknown_mapping_is_refused_with_the_known_ones() -> None:
    core = Kinematics(device_json(PHANTOM))
    zero = (0.0, 0.0, 0.0)
    with pytest.raises(ValueError, match="transpose"):
        core.joint_set_point("sideways", q=zero, qd=zero, x_sd=zero, xd_sd=zero, k_q=zero, k_c=0.0)


def planar_normals() -> list[np.ndarray]:
    """24 unit vectors in the plane of the two links, 15° apart."""
    return [np.array([np.cos(a), 0.0, np.sin(a)]) for a in np.radians(np.arange(0, 360, 15))]


def static_force(
    core: Kinematics, mapping: str, q: np.ndarray, normal: np.ndarray, k_q: np.ndarray
) -> np.ndarray:
    """Tip force of a tip pressed 0.01 mm against a rigid wall, N."""
    jacobian, still = np.array(core.jacobian(q)), (0.0, 0.0, 0.0)
    k_c = isotropic_stiffness(jacobian, k_q)
    x_sd = np.array(core.forward(q)) + 1e-5 * normal
    q_sd, _ = core.joint_set_point(mapping, q=q, qd=still, x_sd=x_sd, xd_sd=still, k_q=k_q, k_c=k_c)
    return np.linalg.solve(jacobian.T, k_q * (np.array(q_sd) - q))


def signed_angle(a: np.ndarray, b: np.ndarray) -> float:
    """Angle from a to b in the plane, rad."""
    return float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
