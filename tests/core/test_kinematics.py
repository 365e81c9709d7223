"""Both linkages of the core against the numpy reference."""

import numpy as np
import pytest

from hapticd._core import Kinematics
from tests.oracle import linkage
from tests.oracle.devices import BOTH, HHD, PHANTOM, device_json, poses


@pytest.mark.parametrize("name", BOTH)
def test_tip_is_where_rotations_and_circles_put_it(name: str) -> None:
    core, forward = Kinematics(device_json(name)), linkage.forward_of(name)
    for q in poses(name, 300, seed=1):
        assert np.allclose(core.forward(q), forward(q), rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", BOTH)
def test_jacobian_is_the_derivative_of_the_reference(name: str) -> None:
    core, forward = Kinematics(device_json(name)), linkage.forward_of(name)
    for q in poses(name, 300, seed=2):
        assert np.allclose(core.jacobian(q), linkage.jacobian(forward, q), rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", BOTH)
def test_inverse_finds_the_pose_a_newton_search_finds(name: str) -> None:
    core, forward = Kinematics(device_json(name)), linkage.forward_of(name)
    rng = np.random.default_rng(3)
    compared = 0
    for q in poses(name, 200, seed=3):
        if core.singularity_margin(q) < 0.1:
            continue
        near = q + rng.uniform(-0.02, 0.02, 3) * (np.array([1, 1, 0]) if name == HHD else 1)
        found = core.inverse(forward(q).real)
        assert found is not None
        assert np.allclose(found, linkage.inverse(forward, forward(q), near), rtol=0, atol=1e-9)
        compared += 1
    assert compared > 150


@pytest.mark.parametrize("name", BOTH)
def test_inverse_jacobian_is_the_pseudo_inverse_of_the_used_axes(name: str) -> None:
    core = Kinematics(device_json(name))
    for q in poses(name, 200, seed=4):
        if core.singularity_margin(q) > 0.05:
            expected = np.linalg.pinv(np.array(core.jacobian(q)), rcond=1e-6)
            found = core.jacobian_inverse(q)
            assert found is not None
            assert np.allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_margin_is_the_normalised_determinant_of_the_rhombus() -> None:
    core = Kinematics(device_json(HHD))
    for q in poses(HHD, 100, seed=5):
        determinant = np.linalg.det(np.array(core.jacobian(q))[:2, :2])
        assert core.singularity_margin(q) == pytest.approx(determinant / 0.2**2, abs=1e-12)


def test_margin_of_the_phantom_vanishes_with_the_determinant() -> None:
    core = Kinematics(device_json(PHANTOM))
    for q in poses(PHANTOM, 100, seed=6):
        x, y, _ = core.forward(q)
        r = np.hypot(x, y)
        determinant = abs(np.linalg.det(np.array(core.jacobian(q))))
        between_links = determinant / (r * 0.14**2)
        behind_axis = np.cos(q[1]) + np.sin(q[2]) <= 0
        to_axis = 0.0 if behind_axis else r / np.linalg.norm(core.forward(q))
        assert core.singularity_margin(q) == pytest.approx(min(between_links, to_axis), abs=1e-9)


def test_workspace_rectangle_of_the_paper_is_reachable_and_not_singular() -> None:
    """KS §2.1 as checked in physics §4.1: x ±190 mm, y 90…320 mm, sin δ ≥ 0.438."""
    core = Kinematics(device_json(HHD))
    margins = []
    for x in np.linspace(-0.19, 0.19, 39):
        for y in np.linspace(0.09, 0.32, 24):
            q = core.inverse((x, y, 0.0))
            assert q is not None
            assert core.inside(q, 0.0)
            margins.append(core.singularity_margin(q))
    assert min(margins) == pytest.approx(0.438, abs=0.001)


def test_device_that_is_not_a_model_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match="kinematics"):
        Kinematics('{"name": "half a device", "dof": 3}')
