"""The heartbeat to the servos: it says that the front is alive, and means it.

A thread beats, so that a busy event loop does not starve the servos. It stops when the event loop has not run
for ``STALL_S``: a front that is wedged is as good as dead, and devices must not stay live under it.
"""

from __future__ import annotations

import asyncio
import threading
import time
from typing import Protocol

import structlog

BEAT_S = 0.05
STALL_S = 2.0

log = structlog.get_logger(__name__)


class Beating(Protocol):
    """Something that takes a heartbeat, from any thread."""

    def heartbeat(self) -> None: ...


class Heartbeat:
    """Beats to every link added, while the event loop runs."""

    def __init__(self, stall_s: float = STALL_S) -> None:
        self._stall_s = stall_s
        self._lock = threading.Lock()
        self._links: set[Beating] = set()
        self._loop_seen_s = time.monotonic()
        self._stalled = False
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._beat_on, name="heartbeat", daemon=True)

    def start(self) -> None:
        """Starts the thread. ``watch_loop`` must run as a task beside it."""
        self._loop_seen_s = time.monotonic()
        self._thread.start()

    def stop(self) -> None:
        """Ends the thread; the servos fade out, if anything is live."""
        self._ended.set()
        self._thread.join()

    def add(self, link: Beating) -> None:
        """Beats to ``link`` from now on, the first time at once."""
        with self._lock:
            self._links.add(link)
            link.heartbeat()

    def remove(self, link: Beating) -> None:
        """Beats to ``link`` no more. Once this returns, the link may be closed."""
        with self._lock:
            self._links.discard(link)

    async def watch_loop(self) -> None:
        """Notes again and again that the event loop runs."""
        while True:
            self._loop_seen_s = time.monotonic()
            await asyncio.sleep(self._stall_s / 10)

    def beat(self) -> None:
        """One beat to every link, unless the event loop has stalled."""
        stalled = time.monotonic() - self._loop_seen_s > self._stall_s
        if stalled != self._stalled:
            self._stalled = stalled
            log.error("heartbeat", event_loop="stalled" if stalled else "running again")
        if not stalled:
            with self._lock:
                for link in tuple(self._links):
                    self._beat_once(link)

    def _beat_once(self, link: Beating) -> None:
        try:
            link.heartbeat()
        except (OSError, RuntimeError) as error:
            # One broken region must not cost the other devices their heartbeat.
            self._links.discard(link)
            log.error("heartbeat failed", error=str(error))

    def _beat_on(self) -> None:
        while not self._ended.wait(BEAT_S):
            self.beat()
