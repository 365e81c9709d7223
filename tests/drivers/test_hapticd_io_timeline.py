"""Counters that wrap, frames that come twice, late or not at all."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hapticd_drivers.hapticd_io.timeline import Timeline, wrapped_distance


@given(st.integers(0, 0xFFFF), st.integers(-0x8000, 0x7FFF))
def test_distances_hold_over_the_wrap(older: int, distance: int) -> None:
    assert wrapped_distance((older + distance) & 0xFFFF, older, 16) == distance


@given(st.integers(0, 0xFFFF), st.lists(st.integers(1, 0x7FFF), min_size=1, max_size=20))
def test_gaps_count_as_lost_and_numbers_only_rise(start: int, steps: list[int]) -> None:
    timeline = Timeline()
    timeline.anchor(0)
    assert timeline.advance(start)
    first, wire = timeline.seq, start
    for step in steps:
        wire += step
        assert timeline.advance(wire & 0xFFFF)
        assert not timeline.advance(wire & 0xFFFF)
        assert not timeline.advance(wire - 1 & 0xFFFF)
    assert timeline.seq == first + sum(steps)
    assert timeline.lost == sum(steps) - len(steps)
    assert timeline.stale == 2 * len(steps)


def test_frames_of_other_types_leave_no_gap() -> None:
    timeline = Timeline()
    timeline.anchor(0)
    timeline.advance(10)
    timeline.pass_by(11)
    timeline.advance(12)
    assert (timeline.seq, timeline.lost) == (2, 0)
    timeline.pass_by(14)  # 13 was lost
    timeline.pass_by(14)
    timeline.advance(15)
    assert (timeline.seq, timeline.lost) == (4, 1)


@given(st.integers(0, 0xFFFF_FFFF), st.lists(st.integers(1, 1 << 30), max_size=20))
def test_the_clock_runs_on_over_its_wrap(start: int, steps: list[int]) -> None:
    timeline = Timeline()
    timeline.anchor(5_000_000)
    assert timeline.read_clock(start) == 5_000_000
    for step in steps:
        start = start + step & 0xFFFF_FFFF
        before = timeline.t_ns
        assert timeline.read_clock(start) == before + 1000 * step


def test_a_clock_that_goes_back_is_not_hidden() -> None:
    timeline = Timeline()
    timeline.anchor(5_000_000)
    timeline.read_clock(1000)
    assert timeline.read_clock(400) == timeline.t_ns == 4_400_000
