"""The event log: what happened, in memory for those who watch and on disk for those who come later."""

from __future__ import annotations

import asyncio
import itertools
import time
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import structlog
from pydantic import Field, ValidationError

from hapticd.snapshot import Report

KEPT_IN_MEMORY = 1000
FILE_MAX_BYTES = 4_000_000
"""Size at which the log turns over; one older file is kept."""

SUBSCRIBER_MAX = 256
"""Events that may wait for one subscriber. They are never dropped: one that falls behind is cut off."""

log = structlog.get_logger(__name__)


class Event(Report):
    """Something that happened. ``id`` rises by one with each event, also across restarts.

    ``kind`` says what, ``tick`` and ``t_mono_ns`` are the loop's where it was the
    loop.
    """

    id: int
    t_utc: datetime
    t_mono_ns: int
    kind: str
    message: str
    device_id: str | None = None
    tick: int | None = None
    details: dict[str, Any] = Field(default_factory=dict)


class EventFeed:
    """The events of one subscriber, oldest first, without a gap."""

    def __init__(self) -> None:
        self._queue: asyncio.Queue[Event] = asyncio.Queue(SUBSCRIBER_MAX)
        self._overflowed = False

    @property
    def overflowed(self) -> bool:
        """Whether the subscriber fell so far behind that it must be cut off."""
        return self._overflowed

    def offer(self, event: Event) -> None:
        """Adds an event; a full feed takes no more, so that what it holds has no gap."""
        if self._overflowed:
            return
        try:
            self._queue.put_nowait(event)
        except asyncio.QueueFull:
            self._overflowed = True

    async def next(self) -> Event | None:
        """The next event; None once everything before an overflow has been taken."""
        if self._overflowed and self._queue.empty():
            return None
        return await self._queue.get()


class EventLog:
    """Every event of the daemon. Belongs to the event loop's thread."""

    def __init__(self, directory: Path) -> None:
        self._file = directory / "events.jsonl"
        self._older = directory / "events.1.jsonl"
        _end_last_line(self._file)
        self._recent: deque[Event] = deque(_read(self._older, self._file), maxlen=KEPT_IN_MEMORY)
        last_id = self._recent[-1].id if self._recent else 0
        self._ids = itertools.count(last_id + 1)
        self._feeds: set[EventFeed] = set()

    def append(
        self,
        kind: str,
        message: str,
        *,
        device_id: str | None = None,
        tick: int | None = None,
        t_mono_ns: int | None = None,
        details: Mapping[str, Any] | None = None,
    ) -> Event:
        """Notes an event and tells every subscriber. A disk that refuses it is logged, never raised."""
        event = Event(
            id=next(self._ids),
            t_utc=datetime.now(UTC),
            t_mono_ns=time.monotonic_ns() if t_mono_ns is None else t_mono_ns,
            kind=kind,
            message=message,
            device_id=device_id,
            tick=tick,
            details=dict(details or {}),
        )
        self._recent.append(event)
        self._write(event)
        for feed in self._feeds:
            feed.offer(event)
        return event

    def after(self, event_id: int = 0, limit: int = KEPT_IN_MEMORY) -> list[Event]:
        """The first ``limit`` events with an id above ``event_id``, of those still kept."""
        later = (event for event in self._recent if event.id > event_id)
        return list(itertools.islice(later, limit))

    def loop_told_until_ns(self, device_id: str, since: datetime) -> int:
        """Time of the last event of a device's loop noted since then, on the loop's clock; 0 for none."""
        times_ns = (
            event.t_mono_ns
            for event in self._recent
            if event.device_id == device_id and event.tick is not None and event.t_utc >= since
        )
        return max(times_ns, default=0)

    @property
    def oldest_id(self) -> int | None:
        """Id of the oldest event still kept."""
        return self._recent[0].id if self._recent else None

    @contextmanager
    def subscribe(self) -> Iterator[EventFeed]:
        """A feed of every event from now on."""
        feed = EventFeed()
        self._feeds.add(feed)
        try:
            yield feed
        finally:
            self._feeds.discard(feed)

    def _write(self, event: Event) -> None:
        try:
            if self._file.exists() and self._file.stat().st_size > FILE_MAX_BYTES:
                self._file.replace(self._older)
            with self._file.open("a", encoding="utf-8") as file:
                file.write(event.model_dump_json() + "\n")
        except OSError as error:
            log.error("event not written", file=str(self._file), error=str(error), event_id=event.id)


def _read(*files: Path) -> Iterator[Event]:
    for file in files:
        if not file.exists():
            continue
        for line in file.read_text(encoding="utf-8", errors="replace").splitlines():
            try:
                yield Event.model_validate_json(line)
            except ValidationError:
                # A line cut short by a power failure; the others stand.
                log.warning("event line unreadable", file=str(file))


def _end_last_line(file: Path) -> None:
    """Ends a line that a power failure cut short, so that it does not take the next event with it."""
    if file.exists() and not file.read_bytes().endswith(b"\n"):
        with file.open("ab") as log_file:
            log_file.write(b"\n")
