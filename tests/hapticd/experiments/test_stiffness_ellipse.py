"""WN Fig. 3 on the twin against numbers worked out apart from the code under test."""

import numpy as np
import pytest

from hapticd.analysis.phantom_pose import PhantomPose
from hapticd.analysis.stiffness import (
    alpha_bound,
    direction_error_rad,
    largest_direction_error_rad,
    locked_joints,
    transposed,
)
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.stiffness_ellipse import EXPERIMENT
from hapticd.model import load_model

JOINT_N_M_PER_RAD = 0.6 * 2.301 * 49
"""K_DC of a joint: 0.6 K_L through ρ = 7."""


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    settings = resolve(EXPERIMENT, {"directions": 5, "steps": 12})
    return EXPERIMENT.run(Run(EXPERIMENT, settings))


def equal_joints(delta_deg: float) -> PhantomPose:
    """A pose with base locked, links of 0.14 m and joints of stiffness one."""
    q = np.radians([0.0, 0.0, delta_deg])
    pose = PhantomPose.of_model(load_model("phantom-1.0"), q)
    return PhantomPose(pose.q, pose.tip, pose.jacobian, np.ones(3))


def test_the_ellipse_on_the_twin_has_the_axes_of_the_links(outcome: Outcome) -> None:
    # K/l² over 1 ± sin 30°
    found = np.linalg.svd(np.array(outcome.results["pose"]["inverse_twin_n_per_m"]), compute_uv=False)
    expected = JOINT_N_M_PER_RAD / 0.14**2 / np.array([0.5, 1.5])
    np.testing.assert_allclose(found, expected, rtol=0.01)


def test_the_ball_on_the_twin_is_round_and_within_the_softest_joint_direction(outcome: Outcome) -> None:
    found = np.array(outcome.results["pose"]["transpose_twin_n_per_m"])
    # With its base free, at r = 0.21 m, the base joint is the softest: 7.67²·1.381/0.21².
    expected = 0.6 * 2.301 * 7.67**2 / 0.21**2
    np.testing.assert_allclose(found, expected * np.eye(2), rtol=0.01, atol=0.002 * expected)


def test_one_stiffness_for_the_workspace_is_one_at_both_poses(outcome: Outcome) -> None:
    here, there = (
        np.array(outcome.results["pose"][f"{name}_twin_n_per_m"])
        for name in ("workspace", "workspace_elsewhere")
    )
    np.testing.assert_allclose(here, there, atol=0.01 * here[0, 0])


def test_no_joint_is_stiffer_than_tuned_and_one_is_just_as_stiff(outcome: Outcome) -> None:
    assert outcome.results["workspace"]["loop_gain"] == pytest.approx([1.0, 1.0])


def test_alpha_over_the_workspace_is_as_tabulated(outcome: Outcome) -> None:
    low, high = outcome.results["workspace"]["alpha_per_m2"]
    assert 13.0 < low < 16.0
    assert high == pytest.approx(51.0, rel=0.02)


@pytest.mark.parametrize("delta_deg", [0.0, 10.0, 30.0, 50.0])
def test_alpha_with_a_locked_base_falls_with_the_angle_between_the_links(delta_deg: float) -> None:
    expected = 1 / (0.14**2 * (1 + np.sin(np.radians(delta_deg))))
    assert alpha_bound(equal_joints(delta_deg).plane_jacobian) == pytest.approx(expected)


def test_the_direction_error_of_locked_joints_is_the_series_of_the_closed_form() -> None:
    pose = equal_joints(30.0)
    stiffness = locked_joints(pose.plane_jacobian, pose.plane_k_q)
    found = np.degrees(direction_error_rad(stiffness, np.radians(np.arange(0, 180, 15))))
    expected = [-19.1, -26.6, -30.0, -23.8, 0, 23.8, 30.0, 26.6, 19.1, 9.9, 0, -9.9]
    np.testing.assert_allclose(found, expected, atol=0.05)
    assert np.degrees(largest_direction_error_rad(stiffness)) == pytest.approx(30.0)


@pytest.mark.parametrize(("share", "error_deg"), [("0.05", 2.4), ("0.1", 4.7), ("0.2", 9.0)])
def test_a_joint_stiffer_than_believed_turns_the_force_as_tabulated(
    outcome: Outcome, share: str, error_deg: float
) -> None:
    assert outcome.results["mismatch_error_deg"][share] == pytest.approx(error_deg, abs=0.1)


def test_one_alpha_for_unequal_joints_is_not_isotropic_and_the_general_form_is(outcome: Outcome) -> None:
    assert outcome.results["unequal_joints"]["stiffest_over_softest_joint"] == pytest.approx(1.2006, abs=1e-3)
    pose = PhantomPose.of_model(load_model("phantom-1.0"), np.array([0.3, 0.1, 0.4]))
    general = transposed(pose.jacobian, pose.k_q, 1500.0 / pose.k_q)
    np.testing.assert_allclose(general, 1500.0 * np.eye(3), atol=1e-9)


def test_only_the_assumption_of_equal_joints_fails(outcome: Outcome) -> None:
    failing = [claim.claim for claim in outcome.claims if claim.verdict == "fails"]
    assert failing == ["All joints of the PHANTOM exhibit the same stiffness"]
