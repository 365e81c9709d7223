"""The stability map in the small: its physics, its repeatability, and taking up where it was stopped."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hapticd.analysis.settling import Contact
from hapticd.experiments import stability_survey
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.stability_map import EXPERIMENT

SMALL = {"columns": 2, "rows": 9, "stiffness_n_per_m": (2e3, 5e5), "damping_n_s_per_m": (0.0, 400.0)}
SMALL_PHANTOM = {"device": "phantom-1.0", "columns": 2, "rows": 7, "r_hat_share": (0.85, 0.95)}


def mapped(state_dir: Path | None = None, **values: Any) -> Outcome:
    return EXPERIMENT.run(Run(EXPERIMENT, resolve(EXPERIMENT, values), state_dir=state_dir))


@pytest.fixture(scope="module")
def hhd() -> Outcome:
    return mapped(**SMALL)


def test_every_claim_holds_on_the_hhd(hhd: Outcome) -> None:
    assert [claim.verdict for claim in hhd.claims] == ["holds"] * 5


def test_soft_walls_settle_and_the_stiffest_do_not(hhd: Outcome) -> None:
    outcome = hhd.traces["map"]["outcome"].reshape(9, 2)
    assert (outcome[0] == 0).all()
    assert (outcome[-1] == 2).all()
    assert sum(hhd.results["points"].values()) == 18


def test_damping_lets_stiffer_walls_settle(hhd: Outcome) -> None:
    settled = hhd.results["largest_settled"]
    assert settled[1] > settled[0]


def test_less_dry_friction_holds_only_softer_walls(hhd: Outcome) -> None:
    assert hhd.results["largest_settled_slippery"][0] < hhd.results["largest_settled"][0]


def test_a_tick_more_of_delay_lowers_the_map(hhd: Outcome) -> None:
    late = mapped(**SMALL, **{"hhd:twin.command_delay_ticks": 1})
    assert max(late.results["largest_settled"]) < max(hhd.results["largest_settled"])
    assert max(late.results["largest_linear"]) < max(hhd.results["largest_linear"])


def test_tuned_at_k_hf_the_phantom_stands_and_past_it_not() -> None:
    outcome = mapped(**SMALL_PHANTOM)
    assert [claim.verdict for claim in outcome.claims] == ["holds"] * 3
    for passive, linear, settled in zip(
        *(outcome.results[f"largest_{name}"] for name in ("passive", "linear", "settled")), strict=True
    ):
        assert passive < linear <= settled < 2.5
    assert outcome.results["largest_linear"] == sorted(outcome.results["largest_linear"])


def test_the_spring_law_is_as_stable_as_the_coupling_of_the_same_slopes(hhd: Outcome) -> None:
    spring = mapped(**SMALL, law="spring")
    assert spring.results["largest_settled"] == hhd.results["largest_settled"]


def test_passivity_brings_every_wall_to_rest() -> None:
    watched = mapped(**SMALL, law="spring", passivity=True)
    assert watched.results["points"]["settled"] == 18
    assert [claim.verdict for claim in watched.claims] == ["holds"] * 5


def test_a_map_that_was_stopped_goes_on_where_it_was_to_the_last_digit(
    tmp_path: Path, hhd: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, pushes = stability_survey.push, []

    def breaks_down(*args: Any, **fields: Any) -> Contact:
        pushes.append(args)
        if len(pushes) > 12:
            raise KeyboardInterrupt
        return real(*args, **fields)

    monkeypatch.setattr(stability_survey, "push", breaks_down)
    with pytest.raises(KeyboardInterrupt):
        mapped(tmp_path, **SMALL)
    assert len(list(tmp_path.iterdir())) == 1
    pushes.clear()
    monkeypatch.setattr(stability_survey, "push", lambda *a, **f: pushes.append(a) or real(*a, **f))
    resumed = mapped(tmp_path, **SMALL)
    assert len(pushes) == 18 - 8 + 9  # four rows of two were kept; the second look is nine more
    assert json.dumps(resumed.results) == json.dumps(hhd.results)
    np.testing.assert_array_equal(resumed.traces["map"]["motion_m"], hhd.traces["map"]["motion_m"])
    assert list(tmp_path.iterdir()) == []


def test_other_parameters_do_not_take_up_a_stopped_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every variant, stopped in its second batch, keeps a file of its own."""
    settings = {**SMALL, "rows": 5}
    variants: tuple[dict[str, Any], ...] = ({}, {"push_share": 0.3}, {"hhd:twin.hand.mass_kg": 1.0})
    for variant in variants:
        pushes: list[Any] = []

        def stopped(*args: Any, pushes: list[Any] = pushes, **_: Any) -> Contact:
            pushes.append(args)
            if len(pushes) > 8:
                raise KeyboardInterrupt
            return Contact(0.0, touching=True, faulty=False)

        monkeypatch.setattr(stability_survey, "push", stopped)
        with pytest.raises(KeyboardInterrupt):
            mapped(tmp_path, **settings, **variant)
    assert len(list(tmp_path.iterdir())) == len(variants)
