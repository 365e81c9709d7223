"""The core's set-point among several walls against trying every set of active walls."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd._core import contact, set_point
from tests.oracle import envelope
from tests.oracle.envelope import Walls

STILL = (0.0, 0.0, 0.0)

Field = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def pull(walls: Walls, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """x_Sd − x: the force at k_c = 1."""
    return np.array(set_point(walls.rows(), x, STILL)[0]) - x


@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("rigid", [0.0, 0.4, 1.0])
def test_set_point_is_the_best_over_all_active_sets(count: int, rigid: float) -> None:
    rng = np.random.default_rng(count)
    for _ in range(150):
        walls = envelope.random_walls(rng, count, rigid=rigid)
        x = rng.uniform(-0.05, 0.05, 3)
        found = set_point(walls.rows(), x, STILL)[0]
        assert np.allclose(found, envelope.set_point(walls, x), rtol=0, atol=2e-7)


def test_set_point_velocity_follows_the_motion_of_the_set_point() -> None:
    rng = np.random.default_rng(7)
    step_s = 1e-6
    compared = 0
    for _ in range(300):
        walls = envelope.random_walls(rng, 4, rigid=0.3)
        x, xd = rng.uniform(-0.05, 0.05, 3), rng.uniform(-0.5, 0.5, 3)
        before, after = (set_point(walls.rows(), x + sign * step_s * xd, xd) for sign in (-1, 1))
        if before[1] == after[1]:
            slope = (np.array(after[0]) - np.array(before[0])) / (2 * step_s)
            assert np.allclose(set_point(walls.rows(), x, xd)[1], slope, rtol=0, atol=1e-6)
            compared += 1
    assert compared > 250


def test_eta_blends_one_wall_as_the_paper_says() -> None:
    """η = 0.3, 10 mm deep: the set-point is 3 mm deep (WN eq. 30, physics §3.4)."""
    x_sd, xd_sd = set_point([((0, 0, 1), 0.0, 0.3)], (0.01, 0, -0.01), (1, 0, -1))
    assert x_sd == pytest.approx((0.01, 0, -0.003), abs=1e-12)
    assert xd_sd == pytest.approx((1, 0, -0.3), abs=1e-12)


@pytest.mark.parametrize("eta", [(0.0, 0.6), (0.2, 0.7), (0.1, 0.4, 0.8)])
def test_loop_in_a_slanted_corner_exchanges_no_energy(eta: tuple[float, ...]) -> None:
    """4 mm loop, 2 N/mm, in both senses; superposing the walls instead would give millijoules."""
    corner = slanted_corner(eta)
    deep = corner_depth(corner)
    envelope_j = loop_energy_j(lambda x: pull(corner, x), deep)
    superposed_j = loop_energy_j(lambda x: envelope.superposed(corner, x) - x, deep)
    assert abs(envelope_j) < 1e-6
    assert abs(superposed_j) > 1e-3


def test_stiffness_in_a_corner_is_a_symmetric_share_of_one_rigid_wall() -> None:
    rng = np.random.default_rng(11)
    for count in (2, 3):
        for _ in range(200):
            walls = envelope.random_walls(rng, count, rigid=0.3)
            x = rng.uniform(-0.05, 0.05, 3)
            columns = [set_point(walls.rows(), x, axis)[1] for axis in np.eye(3)]
            stiffness = np.eye(3) - np.array(columns).T
            assert np.allclose(stiffness, stiffness.T, rtol=0, atol=1e-10)
            eigenvalues = np.linalg.eigvalsh(stiffness)
            assert eigenvalues.min() > -1e-12
            assert eigenvalues.max() < 1 + 1e-12


def test_contact_names_the_deepest_wall() -> None:
    walls = [((0, 0, 1), -0.01, 0.0), ((0, 0, 1), 0.01, 0.5), ((1, 0, 0), 0.02, 0.0)]
    assert contact(walls, (0, 0, 0)) == (2, 2, 0.02, [1, 0, 0])
    assert contact(walls, (0.1, 0, 0.1)) == (0, None, 0.0, [0, 0, 0])


def slanted_corner(eta: tuple[float, ...]) -> Walls:
    """Two or three walls, 60° to one another, through the origin."""
    normals = np.array([[0, 0, 1.0], [np.sin(np.pi / 3), 0, 0.5], [0.3, 0.8, 0.5]])[: len(eta)]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return Walls(normals, np.zeros(len(eta)), np.array(eta))


def corner_depth(walls: Walls) -> NDArray[np.float64]:
    """A point 20 mm deep in every wall, so that a small loop about it stays in all of them."""
    return np.asarray(-np.linalg.pinv(walls.normals) @ np.full(len(walls.eta), 0.02))


def loop_energy_j(field: Field, middle: NDArray[np.float64]) -> float:
    """Work of the field around a 4 mm circle in the x–z plane, midpoint rule."""
    angles = np.linspace(0, 2 * np.pi, 401)
    circle = middle + 0.004 * np.stack([np.cos(angles), 0 * angles, np.sin(angles)], axis=1)
    steps, halfway = np.diff(circle, axis=0), (circle[1:] + circle[:-1]) / 2
    return float(2000.0 * sum(field(x) @ step for x, step in zip(halfway, steps, strict=True)))
