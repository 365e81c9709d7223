"""WN Figs. 5 and 6 on the twin against numbers worked out apart from the code under test."""

import numpy as np
import pytest

from hapticd.experiments.direction_on_device import ESTIMATED
from hapticd.experiments.direction_series import Series, wall_angles
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.force_direction import EXPERIMENT
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.problem import Problem
from hapticd.twin import TwinRun
from tests.hapticd.experiments.twin_bench import TwinBench

HALF_TURN_DEG = [-19.1, -26.6, -30.0, -23.8, 0, 23.8, 30.0, 26.6, 19.1, 9.9, 0, -9.9]
"""Error of inverse mapping for q2 = 0, q3 = 30°, walls every 15°, joints of equal stiffness."""


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    settings = resolve(EXPERIMENT, {"spacing_deg": 30.0})
    return EXPERIMENT.run(Run(EXPERIMENT, settings))


def test_transpose_mapping_is_true_to_a_tenth_of_a_degree(outcome: Outcome) -> None:
    assert outcome.results["transpose"]["max_abs_error_deg"] < 0.1


def test_inverse_mapping_gives_the_series_of_the_closed_form_twice_a_turn(outcome: Outcome) -> None:
    np.testing.assert_allclose(outcome.results["inverse"]["error_deg"], 2 * HALF_TURN_DEG[::2], atol=0.3)
    assert outcome.results["inverse"]["max_abs_error_deg"] == pytest.approx(30.0, abs=0.3)
    assert outcome.results["inverse"]["rms_error_deg"] == pytest.approx(20.5, abs=0.2)


def test_ripple_and_friction_turn_the_force_by_degrees(outcome: Outcome) -> None:
    # 10 % between two joints turn it by up to 4.7°, 0.04 N of friction in 0.9 N by 2.5°.
    assert 1.0 < outcome.results["imperfect"]["transpose"]["max_abs_error_deg"] < 7.0


def test_the_direction_in_motion_is_that_of_the_law_with_hold_and_delay(outcome: Outcome) -> None:
    motion = outcome.results["motion"]
    np.testing.assert_allclose(motion["error_deg"], motion["closed_form_deg"], atol=0.5)
    by_frequency = dict(zip(motion["frequency_hz"], motion["error_deg"], strict=True))
    assert by_frequency[0.5] < 0.1
    assert by_frequency[110.0] > 25.0


def test_a_deep_wall_makes_inverse_mapping_worse() -> None:
    settings = resolve(
        EXPERIMENT,
        {"spacing_deg": 90.0, "depth_m": 0.01, "motion": False, "limits.tip_force_n": 200.0,
         "drive.current_max_a": [200.0] * 3, "drive.current_continuous_a": [100.0] * 3,
         "drive.voltage_max_v": [1000.0] * 3, "twin.winding.supply_v": 1000.0,
         "limits.tip_slew_n_per_s": 1e6, "twin.hand.clamp_stiffness_n_per_m": 1e6},
    )  # fmt: skip
    outcome = EXPERIMENT.run(Run(EXPERIMENT, settings))
    assert outcome.results["inverse"]["max_abs_error_deg"] == pytest.approx(32.0, abs=0.5)


def test_links_at_right_angles_need_no_transpose() -> None:
    settings = resolve(
        EXPERIMENT, {"pose_rad": [0.5, 0.5], "spacing_deg": 90.0, "motion": False, "depth_m": 3e-4}
    )
    outcome = EXPERIMENT.run(Run(EXPERIMENT, settings))
    assert outcome.results["inverse"]["max_abs_error_deg"] < 0.5


def test_only_the_scatter_of_the_transpose_fails(outcome: Outcome) -> None:
    failing = [claim.claim for claim in outcome.claims if claim.verdict == "fails"]
    assert failing == ["The errors of Jacobian transpose are not well correlated with the wall normal"]


def test_the_error_is_counter_clockwise_from_normal_to_force() -> None:
    series = Series(np.array([0.0, np.pi / 2]), np.array([[1.0, 0.1], [0.1, 1.0]]), np.zeros_like)
    np.testing.assert_allclose(series.error_rad, [np.arctan(0.1), -np.arctan(0.1)])
    assert series.at(80.0) == pytest.approx(np.degrees(-np.arctan(0.1)))


def test_noise_is_not_taken_for_an_ellipse() -> None:
    angles = wall_angles(15.0)
    noise = np.random.default_rng(1).normal(size=24) * 0.01
    across = np.stack([np.cos(angles + noise), np.sin(angles + noise)], axis=1)
    assert Series(angles, across, np.zeros_like).periodic_share < 0.5


async def test_a_device_with_a_locked_tip_shows_the_same_by_its_motors() -> None:
    settings = resolve(EXPERIMENT, {"spacing_deg": 60.0, "rest_s": 0.1})
    run = Run(EXPERIMENT, settings)
    bench = TwinBench(run.twin("phantom-1.0", overrides={"joints.home_rad": [0.4, 0.0, np.pi / 6]}))
    outcome = await EXPERIMENT.run_on(run, bench)
    assert outcome.results["force_from"] == ESTIMATED
    expected = [HALF_TURN_DEG[i] for i in (0, 4, 8)] * 2
    np.testing.assert_allclose(outcome.results["inverse"]["error_deg"], expected, atol=1.0)
    assert outcome.results["transpose"]["max_abs_error_deg"] < 0.5
    assert bench.scenes[-1]["walls"] == []


async def test_nothing_is_said_of_a_device_whose_tip_is_not_locked() -> None:
    run = Run(EXPERIMENT, resolve(EXPERIMENT, {"spacing_deg": 90.0, "rest_s": 0.0}))
    outcome = await EXPERIMENT.run_on(run, TwinBench(run.twin("phantom-1.0"), is_twin=False))
    assert {claim.verdict for claim in outcome.claims} == {"undecidable"}
    assert all("not locked" in (claim.reason or "") for claim in outcome.claims)


async def test_a_device_with_torque_drives_is_refused() -> None:
    run = Run(EXPERIMENT, resolve(EXPERIMENT, {}))
    with pytest.raises(Problem, match="hhd"):
        await EXPERIMENT.run_on(run, TwinBench(TwinRun("hhd")))


def test_a_pose_that_the_joints_do_not_reach_is_refused() -> None:
    run = Run(EXPERIMENT, resolve(EXPERIMENT, {"pose_rad": [1.7, -0.9]}))
    with pytest.raises(Problem, match="outside of the joint limits"):
        EXPERIMENT.run(run)
