"""The deadlines a loop missed: the last ones in full, and a summary now and then for the log."""

from __future__ import annotations

from collections import deque

from hapticd.realtime import Miss

KEPT = 100

SUMMARY_S = 10.0
"""Least time between two summaries: an overloaded machine must not fill the log."""


class Misses:
    """The misses of one servo since it was attached."""

    def __init__(self) -> None:
        self.recent: deque[Miss] = deque(maxlen=KEPT)
        self._untold = 0
        self._worst: Miss | None = None
        self._told_ns: int | None = None

    def note(self, miss: Miss) -> None:
        """Keeps a miss."""
        self.recent.append(miss)
        self._untold += miss.skipped
        if self._worst is None or miss.skipped > self._worst.skipped:
            self._worst = miss

    def summary(self, now_ns: int) -> str | None:
        """A sentence on the ticks missed since the last one; None when there are none or it is too early."""
        too_early = self._told_ns is not None and now_ns - self._told_ns < SUMMARY_S * 1e9
        worst, untold = self._worst, self._untold
        if worst is None or too_early:
            return None
        self._worst, self._untold, self._told_ns = None, 0, now_ns
        return f"missed {untold} ticks; the worst skipped {worst.skipped}, in the phase {worst.phase}."
