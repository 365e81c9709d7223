"""How well one loop keeps time: what scheduling it obtained, how late it wakes, what it missed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hapticd.snapshot import Report

if TYPE_CHECKING:
    from hapticd._core import HistogramStatus, ServoEvent, ServoStatus


class Histogram(Report):
    """Durations since the servo started. ``counts[i]`` of them lie in ``[edges_ns[i], edges_ns[i + 1])``."""

    count: int
    sum_ns: int
    max_ns: int
    p50_ns: int
    p99_ns: int
    p999_ns: int
    edges_ns: list[int]
    counts: list[int]

    @classmethod
    def of(cls, status: HistogramStatus) -> Histogram:
        """The histogram without its empty upper buckets, which are most of them."""
        used = max((i + 1 for i, count in enumerate(status["counts"]) if count), default=0)
        kept = {**status, "counts": status["counts"][:used], "edges_ns": status["edges_ns"][: used + 1]}
        return cls.model_validate(kept)


class Scheduling(Report):
    """What the servo asked for and what the kernel says it obtained, with its lateness at start-up."""

    realtime: str
    realtime_ok: bool
    policy: str
    priority: int
    cpu: int | None
    memory_locked: bool
    problems: list[str]
    selftest_samples: int
    selftest_median_ns: int
    selftest_p99_ns: int
    selftest_max_ns: int


class Miss(Report):
    """A deadline missed: how many ticks were skipped, and which phase of the tick before took too long."""

    tick: int
    t_mono_ns: int
    skipped: int
    phase: str
    lateness_ns: int
    exchange_ns: int
    compute_ns: int

    @classmethod
    def of(cls, event: ServoEvent) -> Miss:
        """The miss a servo told of."""
        return cls(tick=event["tick"], t_mono_ns=event["t_mono_ns"], **event["details"])


class RealtimeReport(Report):
    """Everything about one loop's timing since it started. ``misses`` are the last ones, oldest first."""

    device_id: str
    rate_hz: float
    tick: int
    missed_ticks: int
    requests_applied: int
    scheduling: Scheduling
    lateness: Histogram
    exchange: Histogram
    compute: Histogram
    misses: list[Miss]


def realtime_report(
    device_id: str, rate_hz: float, status: ServoStatus, misses: Sequence[Miss]
) -> RealtimeReport:
    """The report in a servo's status."""
    return RealtimeReport(
        device_id=device_id,
        rate_hz=rate_hz,
        tick=status["tick"],
        missed_ticks=status["missed_ticks"],
        requests_applied=status["requests_applied"],
        scheduling=Scheduling.model_validate(status["scheduling"]),
        lateness=Histogram.of(status["lateness"]),
        exchange=Histogram.of(status["exchange"]),
        compute=Histogram.of(status["compute"]),
        misses=list(misses),
    )
