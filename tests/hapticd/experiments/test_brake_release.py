"""KS Fig. 5 on the twin and in closed form."""

from __future__ import annotations

import pytest

from hapticd.experiments.brake_release import EXPERIMENT
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    return EXPERIMENT.run(Run(EXPERIMENT, resolve(EXPERIMENT, {})))


def test_closed_form_is_off_the_normal_as_computed_by_hand(outcome: Outcome) -> None:
    # At (0, 200) mm the links stand at 30° and 150°: each joint pushes along the other link.
    forms = outcome.results["closed_form"]
    assert [form["compression_deg"] for form in forms] == pytest.approx([0.0, 0.0, 0.0], abs=1e-4)
    assert [form["release_deg"] for form in forms] == pytest.approx([90.0, 66.9, 42.0], abs=0.1)
    assert forms[0]["brake_let_go_deg"] == pytest.approx(60.0)


def test_motor_and_brake_push_along_the_normal_only_in_compression(outcome: Outcome) -> None:
    found = outcome.results["one_of_each"]
    assert found["compression_max_deg"] < 2.0
    assert found["release_max_deg"] > 80.0
    assert 55.0 < found["release_median_deg"] < 85.0


def test_both_on_every_joint_push_along_the_normal_always(outcome: Outcome) -> None:
    for case in ("motors", "motors_and_brakes"):
        assert outcome.results[case]["compression_max_deg"] < 5.0
        assert outcome.results[case]["release_max_deg"] < 5.0


def test_every_claim_of_the_figure_holds(outcome: Outcome) -> None:
    assert [claim.verdict for claim in outcome.claims] == ["holds"] * 4
