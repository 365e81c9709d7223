"""Brake model and allocation of the core against their restatement, over random histories."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd._core import Allocator, Brakes, Kinematics
from tests.oracle.allocation import Joint, Logic, ParticleBrake, releasing
from tests.oracle.devices import HHD, PHANTOM, device, device_json, poses

PERIOD_S = 0.001
MODEL = device(HHD)["brakes"]
LOGIC = Logic(
    omega_on=MODEL["omega_on_rad_per_s"],
    omega_off=MODEL["omega_off_rad_per_s"],
    hand_min_nm=MODEL["hand_torque_min_nm"],
    brake_max_nm=MODEL["torque_max_nm"][0],
    period_s=PERIOD_S,
)
Vector = NDArray[np.float64]


@pytest.mark.parametrize("dead_time_s", [0.0, 0.003, 0.058])
def test_brake_follows_random_commands_through_dead_time_hysteresis_and_lag(dead_time_s: float) -> None:
    model = device(HHD)
    model["brakes"]["dead_time_s"] = dead_time_s
    core, rng = Brakes(json.dumps(model), PERIOD_S), np.random.default_rng(1)
    oracle = ParticleBrake(10.0, MODEL["lag_s"], dead_time_s, MODEL["hysteresis"], PERIOD_S)
    for _ in range(40):
        asked_nm = float(rng.uniform(0, 10))
        for _ in range(int(rng.integers(1, 30))):
            built_up = core.step([asked_nm, 0.0, 0.0])
            assert built_up == pytest.approx([oracle.step(asked_nm), 0.0, 0.0])


def test_device_without_brakes_has_no_brake_model() -> None:
    for kind in (Brakes, Allocator):
        with pytest.raises(ValueError, match="no brakes"):
            kind(device_json(PHANTOM), PERIOD_S)


def slow_or_fast(rng: np.random.Generator) -> float:
    """Velocities around both thresholds."""
    return float(rng.choice([-1, 1]) * 10 ** rng.uniform(-2.5, 0.5))


class History:
    """A rhombus at rest and in motion, with both allocations side by side."""

    def __init__(self, seed: int) -> None:
        self.core = Allocator(device_json(HHD), PERIOD_S)
        self.kinematics = Kinematics(device_json(HHD))
        self.rng = np.random.default_rng(seed)
        self.q = poses(HHD, 50, seed=seed)
        self.usable = [False, False]
        self.motor_nm = [0.0, 0.0]

    def compare(self, mode: str) -> None:
        jacobian = np.array(self.kinematics.jacobian(self.rng.choice(self.q)))
        inverse = np.linalg.pinv(jacobian)
        force_n = np.array([*self.rng.uniform(-60, 60, 2), 0.0])
        hand_n = np.array([*self.rng.uniform(-60, 60, 2), 0.0])
        torque_nm, hand_nm = jacobian.T @ force_n, jacobian.T @ hand_n
        qd = np.array([slow_or_fast(self.rng), slow_or_fast(self.rng), 0.0])
        brake_nm = np.array([*self.rng.uniform(0, 8, 2), 0.0])
        motor, brake, usable = self.core.split(
            mode,
            jacobian_inverse=inverse,
            force_n=force_n,
            torque_nm=torque_nm,
            qd=qd,
            hand_force_n=hand_n,
            hand_torque_nm=hand_nm,
            brake_nm=brake_nm,
        )
        joints = [Joint(*row) for row in zip(torque_nm, qd, hand_nm, brake_nm, strict=True)][:2]
        barred = mode == "motor_only" or releasing(LOGIC, joints, force_n, hand_n)
        self.usable = [
            not barred and LOGIC.usable(joint, before)
            for joint, before in zip(joints, self.usable, strict=True)
        ]
        assert usable == [*self.usable, False]
        self.compare_motors(mode, joints, motor)
        self.compare_brakes(mode, joints, brake, inverse, force_n)

    def compare_motors(self, mode: str, joints: list[Joint], motor_nm: list[float]) -> None:
        shared = zip(joints, self.usable, self.motor_nm, strict=True)
        expected = [0.0, 0.0] if mode == "brake_only" else [LOGIC.motor_nm(*row) for row in shared]
        self.motor_nm = expected
        relieved = zip(joints, self.usable, expected, strict=True)
        relief = [0.0, 0.0] if mode == "brake_only" else [LOGIC.relief_nm(*row) for row in relieved]
        assert motor_nm[:2] == pytest.approx(np.add(expected, relief))

    def compare_brakes(
        self, mode: str, joints: list[Joint], brake_nm: list[float], inverse: Vector, force_n: Vector
    ) -> None:
        expected = [LOGIC.brake_nm(*row) for row in zip(joints, self.usable, strict=True)]
        if mode == "brake_only" and sum(self.usable) == 1:
            lone = self.usable.index(True)
            expected[lone] = projected(inverse[lone], force_n, joints[lone].wanted_nm)
        assert brake_nm[:2] == pytest.approx(expected)


def projected(unit: Vector, force_n: Vector, wanted_nm: float) -> float:
    """Torque of a lone brake: the best fit of its force to the one wanted, within 45°."""
    fit = float(np.linalg.lstsq(unit[:, None], force_n, rcond=None)[0][0])
    angle = np.arccos(abs(fit) * np.linalg.norm(unit) / np.linalg.norm(force_n))
    within = angle <= np.pi / 4 and fit * wanted_nm > 0
    return min(abs(fit), LOGIC.brake_max_nm) if within else 0.0


@pytest.mark.parametrize("mode", ["motor_only", "motor_and_brake", "brake_only"])
def test_split_follows_its_restatement_through_random_histories(mode: str) -> None:
    history = History(seed=3)
    for _ in range(600):
        history.compare(mode)


def test_blending_with_an_exact_model_leaves_little_error() -> None:
    """A 10 N·m step taken over by a 50 ms brake: motor and brake together give it from the first
    tick (physics §5: the error of an exact model is that of one lag step)."""
    core, brake = Allocator(device_json(HHD), PERIOD_S), Brakes(device_json(HHD), PERIOD_S)
    qd, wanted, built_up, errors = [-0.5, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 0.0, 0.0], []
    for _ in range(300):
        motor, asked, _ = core.split(
            "motor_and_brake",
            jacobian_inverse=np.eye(3),
            force_n=wanted,
            torque_nm=wanted,
            qd=qd,
            hand_force_n=[0.0] * 3,
            hand_torque_nm=[0.0] * 3,
            brake_nm=built_up,
        )
        built_up = brake.step(asked)
        errors.append(abs(motor[0] + built_up[0] - wanted[0]))
    assert max(errors) < 0.2
    assert built_up[0] > 8.0


def test_unknown_mode_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown variant"):
        Allocator(device_json(HHD), PERIOD_S).split(
            "magic",
            jacobian_inverse=np.eye(3),
            **dict.fromkeys(
                ["force_n", "torque_nm", "qd", "hand_force_n", "hand_torque_nm", "brake_nm"], [0.0] * 3
            ),
        )
