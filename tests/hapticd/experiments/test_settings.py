"""What ``--set`` reaches, and what it refuses."""

from __future__ import annotations

import math
from typing import Any

import pytest

from hapticd.experiments.assignment import values_of
from hapticd.experiments.model_keys import model_keys
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.problem import Problem
from tests.hapticd.experiments.fake_experiment import EXPERIMENT


def refusal(**values: Any) -> Problem:
    with pytest.raises(Problem) as caught:
        resolve(EXPERIMENT, values)
    return caught.value


def set_to(*assignments: str) -> Run:
    return Run(EXPERIMENT, resolve(EXPERIMENT, values_of(EXPERIMENT.name, assignments)))


def test_what_is_not_set_has_its_default() -> None:
    run = set_to()
    assert run.number("speed_m_per_s") == 0.25
    assert run.vector("axis") == (1.0, 0.0)
    assert run.overrides("hhd") == {"twin.hand.mass_kg": 1.3}


def test_text_becomes_what_the_parameter_is() -> None:
    run = set_to("speed_m_per_s=1", "runs=3.0", "how=badly", "noisy=false", "axis=0.5,-1")
    assert run.number("speed_m_per_s") == 1.0
    assert run.integer("runs") == 3
    assert run.word("how") == "badly"
    assert run.flag("noisy") is False
    assert run.vector("axis") == (0.5, -1.0)


def test_a_parameter_read_as_what_it_is_not_is_an_error_of_the_experiment() -> None:
    with pytest.raises(TypeError, match="noisy"):
        set_to().number("noisy")


@pytest.mark.parametrize(
    ("value", "words"),
    [(3.0, "0…2 m/s"), ("fast", "finite number"), (math.nan, "finite number"), (True, "finite number")],
)
def test_a_value_that_does_not_fit_names_field_range_and_cure(value: Any, words: str) -> None:
    problem = refusal(speed_m_per_s=value)
    assert problem.slug == "parameter-invalid"
    assert problem.pointer == "/set/speed_m_per_s"
    assert "speed_m_per_s" in problem.detail
    assert words in problem.detail
    assert "speed_m_per_s=0.25" in problem.hint


def test_a_word_outside_the_choices_lists_them() -> None:
    assert refusal(how="perhaps").allowed == ["well", "badly", "crash", "long", "refused"]


def test_a_fraction_is_no_count() -> None:
    assert "whole number" in refusal(runs=2.5).detail


def test_a_list_of_another_length_is_refused() -> None:
    assert "2 finite numbers" in refusal(axis=[1.0]).detail


def test_an_unknown_name_lists_the_known_ones_and_the_nearest() -> None:
    problem = refusal(**{"twin.hand.mas_kg": 1.0})
    assert problem.slug == "parameter-unknown"
    assert problem.allowed is not None
    assert {"runs", "twin.hand.mass_kg", "drive.lag_s", "twin.winding.r_scale"} <= set(problem.allowed)
    assert "Nearest: twin.hand.mass_kg" in problem.detail


def test_a_key_of_two_models_is_set_in_both() -> None:
    run = set_to("twin.hand.mass_kg=0.4")
    assert run.overrides("hhd")["twin.hand.mass_kg"] == 0.4
    assert run.overrides("phantom-1.0")["twin.hand.mass_kg"] == 0.4


def test_a_key_that_names_its_model_is_set_there_alone() -> None:
    run = set_to("phantom-1.0:twin.hand.mass_kg=0.4")
    assert run.overrides("hhd")["twin.hand.mass_kg"] == 1.3
    assert run.overrides("phantom-1.0") == {"twin.hand.mass_kg": 0.4}


def test_what_the_user_sets_stands_above_what_an_experiment_asks_for() -> None:
    run = set_to("drive.lag_s=0.002")
    hhd = run.model("hhd", {"drive.lag_s": 0.001, "brakes.lag_s": 0.03})
    assert '"lag_s": 0.002' in hhd.device_json
    assert '"lag_s": 0.03' in hhd.device_json


def test_what_the_model_itself_refuses_is_told_before_anything_runs() -> None:
    problem = refusal(**{"twin.motor.lag_scale": -3.0})
    assert problem.slug == "parameter-invalid"
    assert "twin.motor.lag_scale" in problem.detail


def test_what_does_not_go_together_with_the_experiments_own_values_is_a_problem() -> None:
    with pytest.raises(Problem, match=r"twin\.motor\.lag_scale"):
        set_to().twin("hhd", overrides={"twin.motor.lag_scale": -1.0})


def test_an_assignment_without_a_value_shows_how_to_write_one() -> None:
    with pytest.raises(Problem, match="--set runs") as caught:
        values_of("fake", ["runs"])
    assert "NAME=VALUE" in caught.value.hint


def test_the_range_of_a_key_is_read_from_its_comment() -> None:
    keys = model_keys("hhd")
    lag = keys["twin.motor.lag_scale"]
    assert (lag.low, lag.high) == (1.0, 4.0)
    assert keys["drive.torque_max_nm"].source == "KS §2.2: 4.44 N·m × 5"
    assert keys["drive.torque_max_nm"].unit == "N·m"


def test_a_key_without_a_comment_says_that_its_source_is_that_of_the_table() -> None:
    source = model_keys("hhd")["twin.hand.grip_stiffness_n_per_m"].source
    assert source.startswith("[twin.hand] fitted to KS")


def test_no_random_number_of_one_purpose_depends_on_another() -> None:
    run = set_to()
    first = run.rng("hands").random()
    run.rng("delays").random(10)
    assert run.rng("hands").random() == first
    assert run.rng("delays").random() != first
