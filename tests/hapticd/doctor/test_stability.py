"""The doctor's word on what each device can render."""

from __future__ import annotations

from pathlib import Path

import pytest

from hapticd.analysis import settling_library
from hapticd.analysis.settling_table import SettlingTable
from hapticd.doctor import Finding, Verdict, stability
from tests.hapticd.doctor.conftest import MakeConfig

RIGID_N_PER_M = 60_000.0


def examined(make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch, settles_n_per_m: float) -> Finding:
    table = SettlingTable((0.0, 400.0), (settles_n_per_m, settles_n_per_m), 50e-6)
    monkeypatch.setattr(settling_library, "settling_table", lambda *_: table)
    (finding,) = stability.examine(make_config(id="desk", model="hhd"))
    return finding


def test_device_that_bears_its_rigid_wall_is_well(
    make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch
) -> None:
    finding = examined(make_config, monkeypatch, 3 * RIGID_N_PER_M)
    assert (finding.subject, finding.verdict) == ("stability of desk", Verdict.OK)
    assert "180 N/mm" in finding.detail
    assert "passive up to 1.19 N/mm" in finding.detail


def test_device_that_does_not_is_worth_a_warning(
    make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch
) -> None:
    finding = examined(make_config, monkeypatch, RIGID_N_PER_M / 2)
    assert finding.verdict is Verdict.WARN
    assert finding.cure is not None
    assert "rate_hz" in finding.cure


def test_the_doctor_leaves_the_state_directory_as_it_was(
    make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    examined(make_config, monkeypatch, RIGID_N_PER_M)
    assert not list(tmp_path.rglob("stability"))
