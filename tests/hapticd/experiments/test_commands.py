"""``hapticd experiment``: what it prints, what it writes, how it ends."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from hapticd.experiments.commands import app
from tests.hapticd.experiments.fake_experiment import FakeExperiment

pytestmark = pytest.mark.usefixtures("fake", "own_places")


@pytest.fixture
def own_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keeps what the commands write out of the home and the working directory."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(tmp_path)


def experiment(*words: str) -> Result:
    return CliRunner(env={"COLUMNS": "200"}).invoke(app, ["experiment", *words])


def test_list_names_every_experiment() -> None:
    assert "fake" in experiment("list").stdout
    (entry,) = json.loads(experiment("list", "--json").stdout)
    assert (entry["name"], entry["title"], entry["on_device"]) == ("fake", FakeExperiment.title, True)


def test_show_prints_every_parameter_with_unit_default_range_and_source() -> None:
    lines = experiment("show", "fake").stdout.splitlines()
    (speed,) = (line for line in lines if "speed_m_per_s " in line and "assumed" in line)
    assert re.split(r"\s{2,}", speed) == ["~ speed_m_per_s", "0.25 m/s", "0…2", "Speed; assumed"]
    (friction,) = (line for line in lines if "coulomb_nm" in line and "1,1,0" in line)
    assert friction.startswith("~ ")
    assert "0.2…1.2" in friction
    assert "inferred" in friction


def test_show_as_json_has_the_experiments_own_defaults_of_the_twin() -> None:
    parameters = json.loads(experiment("show", "fake", "--json").stdout)["parameters"]
    by_name = {(entry["model"], entry["name"]): entry for entry in parameters}
    assert by_name[None, "runs"]["default"] == 2
    assert by_name["hhd", "twin.hand.mass_kg"]["default"] == 1.3
    assert by_name["phantom-1.0", "twin.hand.mass_kg"]["default"] == 0.2
    assert by_name["phantom-1.0", "twin.winding.r_scale"]["minimum"] == 0.9


def test_run_prints_the_claims_and_names_the_files(tmp_path: Path) -> None:
    result = experiment("run", "fake", "--set", "speed_m_per_s=0.5", "--out", str(tmp_path / "out"))
    assert result.exit_code == 0
    assert "✗" in result.stdout
    assert "?" in result.stdout
    for kind in ("json", "png", "svg"):
        assert f"wrote {tmp_path / 'out' / 'fake'}.{kind}" in result.stdout
        assert (tmp_path / "out" / f"fake.{kind}").stat().st_size > 0


def test_run_without_a_directory_writes_into_results(tmp_path: Path) -> None:
    experiment("run", "fake")
    assert (tmp_path / "results" / "fake.json").exists()


def test_run_as_json_prints_the_document_and_nothing_else(tmp_path: Path) -> None:
    result = experiment("run", "fake", "--json", "--seed", "5", "--jitter", "2")
    document = json.loads(result.stdout)
    assert (document["experiment"], document["seed"], len(document["jitter"])) == ("fake", 5, 2)
    assert not (tmp_path / "results").exists()


def test_jitter_adds_how_often_each_claim_holds() -> None:
    assert "0 of 2" in experiment("run", "fake", "--jitter", "2", "--set", "speed_m_per_s=1").stdout


def test_an_unknown_experiment_lists_the_known_ones() -> None:
    result = experiment("run", "fakes")
    assert result.exit_code == 1
    assert "fakes" in result.stderr
    assert "Choose one of fake." in result.stderr


def test_a_problem_with_json_is_its_document_on_standard_error() -> None:
    result = experiment("run", "fake", "--json", "--set", "speed=1")
    assert (result.exit_code, result.stdout) == (1, "")
    assert json.loads(result.stderr)["pointer"] == "/set/speed"


def test_a_missing_library_is_one_sentence_with_its_cure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    result = experiment("run", "fake")
    assert result.exit_code == 1
    assert "pip install 'hapticd[experiments]'" in result.stderr


def test_a_daemon_that_is_not_there_is_told() -> None:
    result = experiment("run", "fake", "--device", "hhd", "--url", "http://127.0.0.1:1")
    assert result.exit_code == 1
    assert "The daemon does not answer" in result.stderr


def test_reproduce_writes_the_page_with_claims_misprints_and_figures(tmp_path: Path) -> None:
    assert experiment("reproduce", "--out", str(tmp_path / "docs"), "--draws", "4").exit_code == 0
    page = (tmp_path / "docs" / "reproduction.md").read_text()
    assert "| [fake](#fake) | no paper | 1 | 0 | 1 |" in page
    row = next(line for line in page.splitlines() if line.startswith("| it is slow |"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[4] == "✓ holds"
    assert cells[5].endswith(" of 4")
    assert "undecidable: nobody was asked" in page
    assert "WN eq. 12" in page
    assert "KS §2.2" in page
    assert (tmp_path / "docs" / "images" / "reproduction" / "fake.png").exists()
    assert "](images/reproduction/fake.png)" in page
