"""The core's friction against its restatement in numpy, over random paths."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd._core import Friction, Kinematics
from tests.oracle.devices import BOTH, HHD, device, device_json
from tests.oracle.friction import Anchor, Average, Heading, normal_forces
from tests.oracle.stiffness import isotropic_bound

PERIOD_S = 0.001
STATIC, KINETIC = 0.6, 0.4
Vector = NDArray[np.float64]


def spring_and_damper(name: str) -> tuple[float, float]:
    """Half of the coupling; for spring drives half of k_c, and L/dR and one and a half ticks of it."""
    drive = device(name)["drive"]
    if name == HHD:
        return drive["stiffness_n_per_m"] / 2, drive["damping_n_s_per_m"] / 2
    residual = np.subtract(drive["r_25_ohm"], drive["r_hat_ohm"])
    k_q = np.square(drive["ratio"]) * drive["k_t_nm_per_a"] * drive["k_p_v_per_rad"] / residual
    jacobian = np.array(Kinematics(device_json(name)).jacobian(device(name)["joints"]["home_rad"]))
    stiffness = 0.5 * isotropic_bound(jacobian, k_q)
    return stiffness, stiffness * (max(drive["l_h"] / residual) + 1.5 * PERIOD_S)


def random_path(rng: np.random.Generator, ticks: int) -> tuple[Vector, Vector]:
    """Positions of a tip that rests, creeps and runs, and its velocities, each of shape (ticks, 3)."""
    pace = rng.choice([0.0, 1e-6, 1e-5, 2e-4], size=ticks // 50).repeat(50)
    heading = rng.standard_normal((ticks // 25, 3)).repeat(25, axis=0)
    steps = pace[:, None] * heading / np.linalg.norm(heading, axis=1, keepdims=True)
    return np.cumsum(steps, axis=0), steps / PERIOD_S


def unit(rng: np.random.Generator) -> Vector:
    """A direction."""
    vector = rng.standard_normal(3)
    return np.asarray(vector / np.linalg.norm(vector))


@pytest.mark.parametrize("name", BOTH)
def test_motors_follow_the_elastic_anchor_over_random_paths(name: str) -> None:
    rng, home = np.random.default_rng(5), device(name)["joints"]["home_rad"]
    stiffness, damping = spring_and_damper(name)
    states = set()
    for _ in range(4):
        core, normal = Friction(device_json(name), PERIOD_S), unit(rng)
        path, velocity = random_path(rng, 500)
        oracle = Anchor(stiffness, damping, Average(PERIOD_S), path[0], path[0])
        load = rng.uniform(0, 30, 10).repeat(50)
        found, expected = [], []
        for x, xd, normal_n in zip(path, velocity, load, strict=True):
            wall = (1, normal, normal_n, STATIC, KINETIC, "motor")
            motor_n, brake_n, state = core.force([wall], q=home, x=x, xd=xd)
            force = oracle.force(normal, x, xd, (STATIC * normal_n, KINETIC * normal_n))
            found.append([*motor_n, *brake_n, state])
            expected.append([*force, 0.0, 0.0, 0.0, 1 if oracle.sticks else 2])
            states.add(state)
        assert np.allclose(found, expected, rtol=0.0, atol=1e-6)
    assert states == {1, 2}


def test_brakes_point_against_slip_or_hand_over_random_paths() -> None:
    rng, home = np.random.default_rng(6), device(HHD)["joints"]["home_rad"]
    for _ in range(4):
        core, oracle, normal = Friction(device_json(HHD), PERIOD_S), Heading(Average(PERIOD_S)), unit(rng)
        path, velocity = random_path(rng, 500)
        hand = rng.normal(0, 10, 3)
        normal_n = max(0.0, float(-normal @ hand))
        found, expected = [], []
        for x, xd in zip(path, velocity, strict=True):
            wall = (1, normal, 1.0, STATIC, KINETIC, "brake")
            motor_n, brake_n, _ = core.force([wall], q=home, x=x, xd=xd, hand_force_n=hand)
            found.append([*motor_n, *brake_n])
            expected.append(
                [0.0, 0.0, 0.0, *oracle.force(normal, xd, hand, (STATIC * normal_n, KINETIC * normal_n))]
            )
        assert np.allclose(found, expected, rtol=0.0, atol=1e-9)


def test_measured_push_is_shared_between_the_walls_of_a_corner() -> None:
    rng, home = np.random.default_rng(7), device(HHD)["joints"]["home_rad"]
    for _ in range(30):
        normals = np.array([unit(rng), unit(rng)])
        if abs(normals[0] @ normals[1]) > 0.5:
            continue
        hand = rng.normal(0, 20, 3)
        core = Friction(device_json(HHD), PERIOD_S)
        for wall in range(2):
            # One wall rubs, the other one only takes its share of the push.
            walls = [(i, normals[i], 2.0, float(i == wall), float(i == wall), "motor") for i in range(2)]
            slip = np.cross(*normals) / np.linalg.norm(np.cross(*normals))
            for tick in range(60):
                x = (tick + 1000 * wall) * 2e-3 * slip
                motor_n, *_ = core.force(walls, q=home, x=x, xd=2 * slip, hand_force_n=hand)
            expected = -normal_forces(normals, hand)[wall] * slip
            assert motor_n == pytest.approx(expected, abs=0.01 * float(np.linalg.norm(hand)))


def test_friction_of_an_unknown_actuator_is_refused() -> None:
    wall = (1, [0.0, 1.0, 0.0], 1.0, STATIC, KINETIC, "magic")
    still = [0.0, 0.0, 0.0]
    with pytest.raises(ValueError, match="unknown variant"):
        Friction(json.dumps(device(HHD)), PERIOD_S).force([wall], q=still, x=still, xd=still)
