"""KS Figs. 11 and 12 on the twin, with a faster pull and fewer walls, and the rule as printed."""

from __future__ import annotations

import pytest

from hapticd.experiments import friction_drag
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.friction import EXPERIMENT
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve

CASES = [(strength, system) for strength in ("weak", "strong") for system in ("active", "hybrid")]


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(friction_drag, "STIFFNESSES_N_PER_M", (20e3, 100e3))
        return EXPERIMENT.run(Run(EXPERIMENT, resolve(EXPERIMENT, {"pull_s": 1.2})))


@pytest.mark.parametrize(("strength", "system"), CASES)
def test_pull_peaks_at_the_static_force_and_drops_to_the_kinetic_one(
    outcome: Outcome, strength: str, system: str
) -> None:
    found = outcome.results[strength][system]
    # Brakes' drag and bearings add up to 6 N along the wall.
    assert 0.6 * found["normal_n"] < found["static_peak_n"] < 0.6 * found["normal_n"] + 9.0
    assert 0.4 * found["normal_n"] < found["kinetic_n"] < 0.4 * found["normal_n"] + 9.0
    assert found["static_peak_n"] > 1.1 * found["kinetic_n"]
    assert found["way_m"] > 0.02


@pytest.mark.parametrize(("strength", "system"), CASES)
def test_friction_comes_to_rest_and_gives_nothing_back(outcome: Outcome, strength: str, system: str) -> None:
    found = outcome.results[strength][system]
    assert found["stable"]
    assert found["unwanted_active_work_j"] < 0.01 * found["hand_work_j"]


def test_wall_too_stiff_for_the_motors_stands_in_neither_system(outcome: Outcome) -> None:
    stiffest = outcome.results["largest_stable_stiffness_n_per_m"]
    assert set(stiffest.values()) == {20e3}


def test_friction_as_printed_vanishes_when_the_hand_lets_go(outcome: Outcome) -> None:
    printed, corrected = (outcome.results["let_go"][rule] for rule in ("printed", "corrected"))
    assert printed["force_after_n"] == 0.0
    assert corrected["force_after_n"] == pytest.approx(8.0)
    assert printed["coast_m"] > 10.0 * corrected["coast_m"]
    # The corrected rule stops it in m v²/2 over μ_k N and the tip's own friction: 0.13² / 2 / 8.5 m.
    assert corrected["coast_m"] == pytest.approx(0.13**2 / 2.0 / 8.5, rel=0.4)
    verdicts = {claim.claim: claim.verdict for claim in outcome.claims}
    misprint = next(verdict for claim, verdict in verdicts.items() if "misprint" in claim)
    assert misprint == "fails"
