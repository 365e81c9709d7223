"""Real-time rights: tried without a trace, graver where they are required."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from hapticd.doctor import Verdict, realtime
from tests.hapticd.doctor.conftest import MakeConfig


def refuse(*_: object) -> None:
    raise PermissionError(1, "Operation not permitted")


def test_trying_leaves_the_scheduling_as_it_was() -> None:
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    realtime.scheduling(priority=80)
    assert (os.sched_getscheduler(0), os.sched_getparam(0)) == before


@pytest.mark.parametrize(("asked", "verdict"), [("preferred", Verdict.WARN), ("required", Verdict.FAIL)])
def test_a_refusal_is_as_grave_as_the_configuration_asks(
    make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch, asked: str, verdict: Verdict
) -> None:
    monkeypatch.setattr("os.sched_setscheduler", refuse)
    finding = next(iter(realtime.examine(make_config(realtime=asked))))
    assert finding.verdict is verdict
    assert finding.cure is not None
    assert "rtprio 98" in finding.cure


def test_nothing_is_tried_where_nobody_asks(make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.sched_setscheduler", refuse)
    (finding,) = realtime.examine(make_config(realtime="off"))
    assert finding.verdict is Verdict.OK


@pytest.mark.parametrize(
    ("runtime_us", "verdict"), [(-1, Verdict.OK), (950_000, Verdict.OK), (500_000, Verdict.WARN)]
)
def test_throttling_is_judged_by_the_share(tmp_path: Path, runtime_us: int, verdict: Verdict) -> None:
    runtime, period = tmp_path / "runtime", tmp_path / "period"
    runtime.write_text(f"{runtime_us}\n")
    period.write_text("1000000\n")
    assert realtime.throttling(runtime, period).verdict is verdict


def test_a_kernel_without_throttling_is_fine(tmp_path: Path) -> None:
    assert realtime.throttling(tmp_path / "none", tmp_path / "none").verdict is Verdict.OK


@pytest.mark.parametrize(
    ("governors", "verdict"),
    [
        ([], Verdict.OK),
        (["performance", "performance"], Verdict.OK),
        (["performance", "powersave"], Verdict.WARN),
    ],
)
def test_one_slow_processor_is_enough_for_a_warning(
    tmp_path: Path, governors: list[str], verdict: Verdict
) -> None:
    for number, governor in enumerate(governors):
        folder = tmp_path / f"devices/system/cpu/cpu{number}/cpufreq"
        folder.mkdir(parents=True)
        (folder / "scaling_governor").write_text(governor + "\n")
    assert realtime.governor(tmp_path).verdict is verdict
