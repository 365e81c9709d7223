"""KS Fig. 2 against numbers worked out by hand and by brute force."""

from __future__ import annotations

import numpy as np
import pytest

from hapticd.analysis.force_ellipse import ball_force_n, box_force_n, ellipse_n
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.workspace_force import EXPERIMENT


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    settings = resolve(EXPERIMENT, {"step_m": 0.01, "push_directions": 4})
    return EXPERIMENT.run(Run(EXPERIMENT, settings))


def verdicts(outcome: Outcome) -> list[str]:
    return [claim.verdict for claim in outcome.claims]


def test_weakest_pose_of_the_motors_is_the_nearest(outcome: Outcome) -> None:
    # At (0, 90) mm σ_max = l√2 cos(δ/2) is largest: 22.2/0.2756 = 80.55 N.
    motors = outcome.results["motors"]
    assert motors["weakest_point_m"] == pytest.approx([0.0, 0.09])
    assert motors["smallest_n"] == pytest.approx(80.55, abs=0.05)
    assert motors["smallest_as_box_n"] == pytest.approx(22.2 / 0.2, rel=0.02)


def test_no_reading_of_the_brakes_gives_36_newton(outcome: Outcome) -> None:
    found = {name: brake["smallest_n"] for name, brake in outcome.results["brakes"].items()}
    assert found == pytest.approx(
        {"before_the_pulley": 72.6, "at_the_joint": 14.5, "inferred": 36.3}, abs=0.1
    )
    assert verdicts(outcome)[-1] == "undecidable"


def test_joint_limits_contain_the_rectangle_without_a_singularity(outcome: Outcome) -> None:
    ranges = outcome.results["joint_range_deg"]
    assert ranges[0] == pytest.approx([-33.4, 99.2], abs=0.2)
    assert ranges[1] == pytest.approx([80.8, 213.4], abs=0.2)
    assert outcome.results["smallest_margin"] == pytest.approx(0.438, abs=0.001)


def test_twin_pushes_harder_than_80_newton_everywhere(outcome: Outcome) -> None:
    assert outcome.results["pushes"]["count"] == 20
    assert outcome.results["pushes"]["smallest_n"] > 80.0


def test_force_bounds_are_those_of_brute_force() -> None:
    rng = np.random.default_rng(3)
    jacobian = rng.normal(size=(2, 2))
    angle = rng.uniform(0.0, 2.0 * np.pi, 5)
    torque = 3.0 * np.stack([np.cos(grid := np.linspace(0, 2 * np.pi, 200_000)), np.sin(grid)])
    reached = np.linalg.solve(jacobian.T, torque)
    for direction, ball, box in zip(
        angle, ball_force_n(jacobian, 3.0, angle), box_force_n(jacobian, 3.0, angle), strict=True
    ):
        unit = np.array([np.cos(direction), np.sin(direction)])
        along = reached[:, np.argmax(unit @ reached / np.linalg.norm(reached, axis=0))]
        assert ball == pytest.approx(np.linalg.norm(along), rel=1e-3)
        assert np.abs(jacobian.T @ (box * unit)).max() == pytest.approx(3.0)


def test_every_point_of_the_ellipse_needs_the_same_torque() -> None:
    jacobian = np.array([[0.1, -0.2], [0.15, 0.05]])
    torque = jacobian.T @ ellipse_n(jacobian, 7.0)
    assert np.linalg.norm(torque, axis=0) == pytest.approx(7.0)
