"""How far a run is, and whether anybody still wants it."""

from __future__ import annotations

import threading
from collections.abc import Callable

Report = Callable[[float, str], None]
"""Is told how far a run is, 0…1, and what it is doing. May be called from several threads, one at a time."""


class Cancelled(Exception):
    """The run was cancelled. Experiments let it pass."""


class Progress:
    """The progress of one run. Safe to use from several threads."""

    def __init__(self, report: Report | None = None, cancelled: threading.Event | None = None) -> None:
        self._report = report
        self._cancelled = cancelled
        self._lock = threading.RLock()
        self.fraction = 0.0

    def tell(self, fraction: float, doing: str) -> None:
        """Tells how far the run is; never goes back. ``Cancelled`` once nobody wants it."""
        if self._cancelled is not None and self._cancelled.is_set():
            raise Cancelled
        with self._lock:
            self.fraction = min(max(fraction, self.fraction), 1.0)
            if self._report is not None:
                self._report(self.fraction, doing)

    def silent(self) -> Progress:
        """A progress that tells nobody, and is cancelled with this one."""
        return Progress(None, self._cancelled)

    def part(self, begin: float, end: float) -> Progress:
        """The progress of a part that takes this one from ``begin`` to ``end``."""
        return Progress(
            lambda fraction, doing: self.tell(begin + (end - begin) * fraction, doing), self._cancelled
        )
