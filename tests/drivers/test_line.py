"""The emulated cable."""

from __future__ import annotations

import pytest

from hapticd_drivers.error import OptionError
from hapticd_drivers.line import Line, LineFaults, Span

FRAMES = [bytes([number % 255 + 1, 7, 0]) for number in range(1000)]


def through(spec: str, seed: int = 3) -> list[bytes]:
    line = Line(LineFaults.parse(spec), seed)
    for frame in FRAMES:
        line.push(frame, 0.0)
    return [part + b"\0" for part in line.pull(1e9).split(b"\0")[:-1]]


def test_a_good_cable_carries_bytes_unchanged_and_at_once() -> None:
    assert through("") == FRAMES


def test_losing_loses_about_the_fraction_asked_for() -> None:
    arrived = through("lose=0.25")
    assert 650 < len(arrived) < 850
    assert set(arrived) <= set(FRAMES)


def test_damage_flips_one_bit_of_about_the_fraction_asked_for() -> None:
    assert 150 < sum(a != b for a, b in zip(through("corrupt=0.2"), FRAMES, strict=False)) < 1000


def test_doubling_and_swapping_lose_nothing() -> None:
    assert len(through("duplicate=0.5")) > 1400
    swapped = through("reorder=0.3")
    assert swapped != FRAMES
    assert sorted(swapped) == sorted(FRAMES)


def test_a_delay_is_bounded_and_keeps_the_order() -> None:
    line = Line(LineFaults.parse("delay=0.01"), 3)
    for number, frame in enumerate(FRAMES):
        line.push(frame, number * 1e-3)
    now_s, arrived = 0.0, b""
    while (now_s := line.next_s()) < float("inf"):
        arrived += line.pull(now_s)
        assert arrived.count(0) >= (now_s - 0.01) / 1e-3 - 1
    assert arrived == b"".join(FRAMES)


def test_one_seed_gives_one_run() -> None:
    spec = "lose=0.1,corrupt=0.1,duplicate=0.1,reorder=0.1"
    assert through(spec, 1) == through(spec, 1) != through(spec, 2)


def test_spans_start_and_end_when_asked() -> None:
    faults = LineFaults.parse("mute=5+0.5,unplug=10")
    assert [faults.mute.covers(t) for t in (4.9, 5.0, 5.4, 5.5)] == [False, True, True, False]
    assert (faults.unplug, LineFaults().unplug.covers(1e9)) == (Span(10.0), False)


@pytest.mark.parametrize(
    "spec",
    [
        "loose=1",
        "lose",
        "lose=2",
        "lose=-1",
        "lose=nan",
        "lose=a",
        "delay=11",
        "mute=",
        "mute=-1",
        "unplug=1+2+3",
    ],
)
def test_a_wrong_fault_is_refused_by_name(spec: str) -> None:
    with pytest.raises(OptionError, match=spec.split("=")[0]):
        LineFaults.parse(spec)
