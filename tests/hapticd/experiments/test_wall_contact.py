"""KS Figs. 8 and 9 on the twin: what each way of rendering a hard wall is known for."""

from __future__ import annotations

from typing import Any

import pytest

from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.wall_contact import EXPERIMENT


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    return EXPERIMENT.run(Run(EXPERIMENT, resolve(EXPERIMENT, {"watch_s": 0.7})))


def found(outcome: Outcome, strength: str, wall: str) -> dict[str, Any]:
    numbers: dict[str, Any] = outcome.results[strength][wall]
    return numbers


def test_hand_arrives_as_fast_as_it_was_told(outcome: Outcome) -> None:
    for wall in ("active", "popc", "passivity", "hybrid"):
        assert found(outcome, "weak", wall)["contact_speed_m_per_s"] == pytest.approx(0.25, rel=0.06)
        assert found(outcome, "strong", wall)["contact_speed_m_per_s"] == pytest.approx(1.5, rel=0.02)


def test_spring_holds_a_weak_push_and_oscillates_under_a_strong_one(outcome: Outcome) -> None:
    weak, strong = found(outcome, "weak", "active"), found(outcome, "strong", "active")
    assert weak["bounces"] >= 1
    assert weak["settled"]
    # 27 N less some 9 N of friction on 150 N/mm is 0.12 to 0.18 mm.
    assert 0.10e-3 < weak["steady_error_m"] < 0.20e-3
    assert not strong["settled"]
    assert strong["bounces"] > 10


def test_published_passivity_control_bounces_once_and_rests(outcome: Outcome) -> None:
    for strength in ("weak", "strong"):
        popc = found(outcome, strength, "popc")
        assert popc["settled"]
        assert popc["bounces"] == 1
        assert popc["steady_error_m"] < 0.5e-3


def test_passivity_control_brings_both_to_rest(outcome: Outcome) -> None:
    for strength in ("weak", "strong"):
        active, passive = found(outcome, strength, "active"), found(outcome, strength, "passivity")
        assert passive["settled"]
        assert passive["bounces"] <= 2
        assert passive["returned_energy_j"] < 5e-3 < active["returned_energy_j"]


def test_brakes_stop_the_hand_without_a_bounce_where_it_has_come_to(outcome: Outcome) -> None:
    weak, strong = found(outcome, "weak", "hybrid"), found(outcome, "strong", "hybrid")
    assert weak["bounces"] == strong["bounces"] == 0
    assert weak["settled"]
    assert strong["settled"]
    assert 0.6e-3 < weak["steady_error_m"] < 2.4e-3
    assert 5e-3 < strong["steady_error_m"] < 25e-3


def test_strong_contact_loads_the_hand_with_some_100_newton(outcome: Outcome) -> None:
    for wall in ("active", "passivity", "hybrid"):
        assert 90.0 < found(outcome, "strong", wall)["peak_force_n"] < 130.0
