"""Missed deadlines: told soon, and not too often."""

from hapticd.misses import KEPT, SUMMARY_S, Misses
from hapticd.realtime import Miss


def miss(tick: int, skipped: int = 1, phase: str = "wake") -> Miss:
    return Miss(
        tick=tick, t_mono_ns=tick, skipped=skipped, phase=phase, lateness_ns=0, exchange_ns=0, compute_ns=0
    )


def test_first_miss_is_told_at_once_and_later_ones_together() -> None:
    misses = Misses()
    assert misses.summary(0) is None
    misses.note(miss(1, skipped=3, phase="exchange"))
    assert misses.summary(0) == "missed 3 ticks; the worst skipped 3, in the phase exchange."
    misses.note(miss(2))
    misses.note(miss(3))
    assert misses.summary(int(SUMMARY_S * 1e9) - 1) is None
    told = misses.summary(int(SUMMARY_S * 1e9))
    assert told == "missed 2 ticks; the worst skipped 1, in the phase wake."
    assert misses.summary(int(3 * SUMMARY_S * 1e9)) is None


def test_only_the_last_ones_are_kept() -> None:
    misses = Misses()
    for tick in range(KEPT + 20):
        misses.note(miss(tick))
    assert [kept.tick for kept in misses.recent] == list(range(20, KEPT + 20))
