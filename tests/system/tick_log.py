"""Every tick of a device, read from its shared memory beside the front."""

from __future__ import annotations

import threading
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from hapticd import _core
from hapticd.record import record_dtype

PERIOD_S = 0.2
READ_MAX = 4096

Ticks = np.ndarray[Any, np.dtype[np.void]]
Values = np.ndarray[Any, np.dtype[Any]]


class TickLog:
    """Collects ticks in a thread while the block runs, faster than the ring forgets."""

    def __init__(self, region: Path) -> None:
        self._front = _core.Front(str(region), observe=True)
        self._next = self._front.head()
        self._parts: list[Ticks] = []
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self.lost = 0

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        self._thread.join()
        self._take()
        self._front.close()

    @property
    def ticks(self) -> Ticks:
        """All ticks read, oldest first."""
        return np.concatenate(self._parts)

    def _run(self) -> None:
        while not self._ended.wait(PERIOD_S):
            self._take()

    def _take(self) -> None:
        while True:
            data, first, lost = self._front.read(self._next, READ_MAX)
            if not data:
                return
            part = np.frombuffer(data, record_dtype())
            self.lost += lost
            self._parts.append(part)
            self._next = first + len(part)
