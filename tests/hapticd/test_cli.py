"""The command line: what it runs, how it shows trouble, and how it ends."""

from __future__ import annotations

import json
from importlib.metadata import EntryPoint, version
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner, Result

import hapticd.doctor
from hapticd import cli, daemon
from hapticd.config import Config
from hapticd.doctor import Finding
from hapticd.doctor.finding import fail, ok, warn
from hapticd.problem import Problem

HARDWARE = """
[[devices]]
id = "arm"
model = "phantom-1.0"
driver = "hapticd_io"
options = { port = "/dev/ttyACM0" }
"""


def run(*words: str) -> Result:
    return CliRunner().invoke(cli.app, list(words))


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> list[Config]:
    """The configurations that were served."""
    configs: list[Config] = []
    monkeypatch.setattr(daemon, "run", configs.append)
    return configs


@pytest.fixture
def hardware(tmp_path: Path) -> str:
    """A configuration file with a device on hardware."""
    file = tmp_path / "config.toml"
    file.write_text(HARDWARE)
    return str(file)


def test_run_serves_the_configured_devices(served: list[Config], hardware: str) -> None:
    assert run("run", "--config", hardware).exit_code == 0
    assert [(device.id, device.driver) for device in served[0].devices] == [("arm", "hapticd_io")]


def test_run_on_twins_leaves_the_hardware_alone(served: list[Config], hardware: str) -> None:
    run("run", "--config", hardware, "--twin")
    (device,) = served[0].devices
    assert (device.id, device.driver, device.options) == ("arm", "twin", {})


def test_run_takes_a_port_for_the_configured_one(served: list[Config], hardware: str) -> None:
    run("run", "--config", hardware, "--port", "9000")
    assert served[0].api.port == 9000


def test_run_names_file_and_key_of_a_wrong_configuration(served: list[Config], tmp_path: Path) -> None:
    file = tmp_path / "config.toml"
    file.write_text("[api]\nprot = 1\n")
    result = run("run", "--config", str(file))
    assert result.exit_code == 1
    assert str(file) in result.stderr.replace("\n", "")
    assert "api.prot" in result.stderr
    assert "Cure:" in result.stderr
    assert not served


def test_run_shows_why_the_daemon_could_not_start(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Config) -> None:
        raise Problem("address-in-use", "127.0.0.1 port 8420 is taken.")

    monkeypatch.setattr(daemon, "run", refuse)
    result = run("run")
    assert result.exit_code == 1
    assert "127.0.0.1 port 8420 is taken." in result.stderr


def diagnosed(monkeypatch: pytest.MonkeyPatch, *findings: Finding) -> None:
    monkeypatch.setattr(hapticd.doctor, "examine", lambda _: iter(findings))


def test_the_doctor_is_content_with_warnings(monkeypatch: pytest.MonkeyPatch) -> None:
    diagnosed(monkeypatch, ok("python", "Python 3."), warn("clock", "It is slow.", "Set it."))
    result = run("doctor")
    assert result.exit_code == 0
    assert "Cure: Set it." in result.stdout


def test_the_doctor_fails_where_something_must_be_mended(monkeypatch: pytest.MonkeyPatch) -> None:
    diagnosed(monkeypatch, ok("python", "Python 3."), fail("core", "It is missing.", "make"))
    result = run("doctor", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)[1] == {
        "subject": "core",
        "verdict": "fail",
        "detail": "It is missing.",
        "cure": "make",
    }


def test_the_doctor_reports_a_wrong_configuration_as_a_finding(tmp_path: Path) -> None:
    file = tmp_path / "config.toml"
    file.write_text("devices = 1\n")
    result = run("doctor", "--json", "--config", str(file))
    last = json.loads(result.stdout)[-1]
    assert result.exit_code == 1
    assert (last["subject"], last["verdict"]) == ("configuration", "fail")


def test_version_is_the_installed_one() -> None:
    result = run("--version")
    assert (result.exit_code, result.stdout.strip()) == (0, version("hapticd"))


def test_a_broken_package_does_not_take_the_other_commands_away(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    entries = [
        EntryPoint("a", "no_such_module:app", cli.GROUP),
        EntryPoint("b", "hapticd_client.commands:app", cli.GROUP),
    ]
    monkeypatch.setattr(cli, "entry_points", lambda group: entries)
    app = typer.Typer()
    cli.add_commands(app)
    assert CliRunner().invoke(app, ["status", "--help"]).exit_code == 0
    assert "no_such_module" in capsys.readouterr().err


def test_the_clients_variable_does_not_keep_the_daemon_from_starting(
    served: list[Config], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HAPTICD_URL", "http://127.0.0.1:9000")
    assert run("run").exit_code == 0
    assert served
