"""Models, drivers and ports of the configured devices."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest

from hapticd.doctor import Finding, Verdict, driver, serial_port
from tests.hapticd.doctor.conftest import MakeConfig

GOOD = EntryPoint("good", "json", driver.GROUP)
BROKEN = EntryPoint("broken", "no_such_module", driver.GROUP)


@pytest.fixture(autouse=True)
def two_drivers(monkeypatch: pytest.MonkeyPatch) -> None:
    """One driver that can be imported, one that cannot."""
    monkeypatch.setattr(driver, "entry_points", lambda group: [GOOD, BROKEN])


@pytest.fixture
def terminal() -> Iterator[str]:
    """The path of a pseudo-terminal, which is a character device like a serial port."""
    board, host = os.openpty()
    yield os.ttyname(host)
    os.close(board)
    os.close(host)


def judged(make_config: MakeConfig, subject: str, **device: Any) -> Finding:
    findings = {finding.subject: finding for finding in driver.examine(make_config(**device))}
    return findings[subject]


def test_a_device_on_a_good_driver_is_fine(make_config: MakeConfig) -> None:
    assert judged(make_config, "driver of phantom", driver="good").verdict is Verdict.OK
    assert judged(make_config, "model of phantom", driver="good").verdict is Verdict.OK


def test_a_driver_that_is_not_installed_is_named_with_those_that_are(make_config: MakeConfig) -> None:
    finding = judged(make_config, "driver of phantom", driver="hapticd_oi")
    assert finding.verdict is Verdict.FAIL
    assert "hapticd_oi" in finding.detail
    assert finding.cure == "Choose among twin, broken, good."


def test_a_broken_driver_fails_the_device_that_uses_it(make_config: MakeConfig) -> None:
    finding = judged(make_config, "driver of phantom", driver="broken")
    assert finding.verdict is Verdict.FAIL
    assert "no_such_module" in finding.detail


def test_a_broken_driver_that_nobody_uses_is_only_warned_of(make_config: MakeConfig) -> None:
    assert judged(make_config, "driver broken").verdict is Verdict.WARN


@pytest.mark.parametrize(
    ("device", "named"),
    [
        ({"model": "phantom-9"}, "phantom-9"),
        ({"overrides": {"limits.tip_farce_n": 1.0}}, "limits.tip_farce_n"),
    ],
)
def test_a_model_that_cannot_be_loaded_names_the_culprit(
    make_config: MakeConfig, device: dict[str, Any], named: str
) -> None:
    finding = judged(make_config, "model of phantom", **device)
    assert finding.verdict is Verdict.FAIL
    assert named in finding.detail


def port_finding(make_config: MakeConfig, port: str) -> Finding:
    (finding,) = serial_port.examine(make_config(driver="good", options={"port": port}))
    return finding


def test_a_port_that_can_be_opened_is_fine(make_config: MakeConfig, terminal: str) -> None:
    assert port_finding(make_config, terminal).verdict is Verdict.OK


def test_a_port_that_is_not_there_fails(make_config: MakeConfig, tmp_path: Path) -> None:
    assert "does not exist" in port_finding(make_config, str(tmp_path / "ttyACM9")).detail


def test_a_file_is_not_taken_for_a_port(make_config: MakeConfig, tmp_path: Path) -> None:
    (tmp_path / "log").write_text("")
    finding = port_finding(make_config, str(tmp_path / "log"))
    assert finding.verdict is Verdict.FAIL
    assert "not a serial port" in finding.detail


def test_a_forbidden_port_names_the_group_to_join(
    make_config: MakeConfig, terminal: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Root may open every port, so the answer of the system is given.
    monkeypatch.setattr("os.access", lambda *_: False)
    cure = port_finding(make_config, terminal).cure
    assert cure is not None
    assert cure.startswith("sudo usermod -aG ")


def test_a_device_without_a_port_is_not_examined_for_one(make_config: MakeConfig) -> None:
    assert not list(serial_port.examine(make_config()))
