"""A run and its files: the same again for the same seed."""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet

from hapticd.experiments.carry_out import Finished, Order, carry_out
from hapticd.experiments.jitter import drawn, jitter
from hapticd.experiments.plain import plain
from hapticd.experiments.progress import Cancelled, Progress
from hapticd.experiments.settings import resolve
from hapticd.problem import Problem
from tests.hapticd.experiments.fake_experiment import EXPERIMENT

FILES = ["fake-runs.parquet", "fake-ticks.parquet", "fake.json", "fake.png", "fake.svg"]


def finished(out: Path | None = None, seed: int = 1, draws: int = 0, **values: Any) -> Finished:
    return carry_out(Order(EXPERIMENT, resolve(EXPERIMENT, values), seed, draws, out))


def test_equal_seeds_give_equal_files_to_the_byte(tmp_path: Path) -> None:
    first, second = finished(tmp_path / "a", 7), finished(tmp_path / "b", 7)
    assert sorted(file.name for file in first.files) == FILES
    for one, other in zip(first.files, second.files, strict=True):
        assert one.read_bytes() == other.read_bytes(), one.name


def test_another_seed_gives_other_results() -> None:
    assert finished(seed=1).document["results"] != finished(seed=2).document["results"]


def test_the_document_is_json_with_what_is_not_finite_as_null(tmp_path: Path) -> None:
    document = finished(tmp_path).document
    assert json.loads((tmp_path / "fake.json").read_text()) == document
    assert document["results"]["a"]["infinite"] is None
    assert list(document["results"]) == ["a", "draw", "z"]
    assert document["seed"] == 1
    assert document["parameters"]["hhd:twin.hand.mass_kg"] == 1.3
    slow, felt = document["claims"]
    assert slow == {
        "claim": "it is slow",
        "source": "no paper",
        "expected": "≤ 0.25 m/s",
        "measured": "0.250 m/s",
        "verdict": "holds",
    }
    assert (felt["verdict"], felt["reason"]) == ("undecidable", "nobody was asked")


def test_what_has_no_json_form_is_an_error() -> None:
    with pytest.raises(TypeError, match="Path"):
        plain({"file": Path()})


def test_columns_of_a_trace_carry_their_units(tmp_path: Path) -> None:
    finished(tmp_path)
    ticks = parquet.read_table(tmp_path / "fake-ticks.parquet")
    assert ticks.num_rows == 50
    assert ticks.schema.field("tip_position_m").metadata == {b"unit": b"m"}
    assert len(ticks["tip_position_m"][0].as_py()) == 3
    assert ticks.schema.metadata[b"experiment"] == b"fake"
    assert (
        parquet.ParquetFile(tmp_path / "fake-ticks.parquet").metadata.row_group(0).column(0).compression
        == "ZSTD"
    )


def test_without_a_directory_no_file_is_written_and_no_library_is_needed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert finished().files == ()


@pytest.mark.parametrize("library", ["matplotlib", "pyarrow"])
def test_a_missing_library_is_told_with_its_cure_before_anything_runs(
    library: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(Problem, match=library) as caught:
        finished(tmp_path, how="crash")
    assert caught.value.slug == "library-missing"
    assert "pip install 'hapticd[experiments]'" in caught.value.hint


def test_a_twin_that_does_not_go_along_is_a_problem_that_names_the_interlock() -> None:
    with pytest.raises(Problem, match="estop-latched") as caught:
        finished(how="refused")
    assert caught.value.slug == "experiment-failed"


def test_draws_keep_to_ten_percent_and_to_the_range() -> None:
    settings = resolve(EXPERIMENT, {"speed_m_per_s": 1.95})
    draws = [drawn(EXPERIMENT, settings, 1, draw) for draw in range(100)]
    speeds = [float(draw.parameters["speed_m_per_s"]) for draw in draws]
    masses = [draw.overrides["hhd"]["twin.hand.mass_kg"] for draw in draws]
    assert min(speeds) < 1.85
    assert max(speeds) == 2.0
    assert 1.17 <= min(masses) < 1.2 < 1.4 < max(masses) <= 1.43
    assert all(draw.parameters["runs"] == 2 for draw in draws)
    assert all("twin.hand.mass_kg" not in draw.overrides["phantom-1.0"] for draw in draws)


def test_every_component_of_a_list_is_drawn_by_itself_and_zero_stays() -> None:
    friction = drawn(EXPERIMENT, resolve(EXPERIMENT, {}), 1, 0).overrides["hhd"]["twin.friction.coulomb_nm"]
    assert friction[0] != friction[1]
    assert friction[2] == 0.0


def test_jitter_counts_how_often_each_claim_holds() -> None:
    slow, felt = jitter(EXPERIMENT, resolve(EXPERIMENT, {"runs": 1}), 1, 12)
    assert slow.holds + slow.fails == slow.draws == 12
    assert slow.holds == sum(
        float(drawn(EXPERIMENT, resolve(EXPERIMENT, {}), 1, draw).parameters["speed_m_per_s"]) <= 0.25
        for draw in range(12)
    )
    assert 0 < slow.holds < 12
    assert felt.undecidable == 12


def test_jitter_is_in_the_document() -> None:
    entry = finished(draws=3, runs=1).document["jitter"][1]
    assert (entry["claim"], entry["draws"], entry["undecidable"]) == ("it is felt", 3, 3)


def test_progress_rises_to_the_end_and_never_falls() -> None:
    told: list[float] = []
    order = Order(EXPERIMENT, resolve(EXPERIMENT, {}), 1, 4)
    carry_out(order, Progress(lambda fraction, _: told.append(fraction)))
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_a_cancelled_run_ends() -> None:
    cancelled = threading.Event()
    cancelled.set()
    with pytest.raises(Cancelled):
        carry_out(Order(EXPERIMENT, resolve(EXPERIMENT, {"how": "long"})), Progress(None, cancelled))
