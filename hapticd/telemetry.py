"""Telemetry: the ring is read once per device and frame, whoever is watching.

A pump wakes at ``PUMP_HZ``, reads the new ticks, and hands each distinct selection of signals one frame,
which all its subscribers share. A subscriber that does not keep up loses its oldest frames and is told how
many ticks they held.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from hapticd.frame import Frame, Records
from hapticd.signals import chosen

PUMP_HZ = 60.0
"""Frames a second at most: what a screen shows."""

QUEUE_MAX = 8
"""Frames that wait for one subscriber before the oldest is dropped."""

READ_MAX_TICKS = 4096
"""Ticks read in one go: more than a pump's period holds at 10 kHz, less than would hold up the event loop."""

Mode = Literal["latest", "batch"]


class TickBatch(Protocol):
    @property
    def records(self) -> Records: ...
    @property
    def first(self) -> int: ...
    @property
    def lost(self) -> int: ...


class TickSource(Protocol):
    """Where ticks come from: a device."""

    def head(self) -> int: ...
    def read(self, since: int, limit: int) -> TickBatch: ...


@dataclass(frozen=True, slots=True)
class Selection:
    """What a subscriber wants: which signals, how often, every tick or the newest."""

    signals: tuple[str, ...]
    mode: Mode
    divisor: int

    @property
    def rate_hz(self) -> float:
        return PUMP_HZ / self.divisor


@dataclass(frozen=True, slots=True)
class Delivery:
    """A frame for one subscriber.

    ``seq`` counts its deliveries from 0, ``dropped`` the ticks it missed before this.
    """

    seq: int
    dropped: int
    frame: Frame


class Subscription:
    """The frames of one subscriber."""

    def __init__(self, selection: Selection) -> None:
        self.selection = selection
        self._frames: deque[Frame] = deque()
        self._ready = asyncio.Event()
        self._dropped = 0
        self._seq = 0

    def offer(self, frame: Frame) -> None:
        """Adds a frame, in place of the oldest when the subscriber is behind."""
        if len(self._frames) == QUEUE_MAX:
            oldest = self._frames.popleft()
            self._dropped += oldest.count + oldest.lost
        self._frames.append(frame)
        self._ready.set()

    async def next(self) -> Delivery:
        """The next frame; waits for it."""
        while not self._frames:
            self._ready.clear()
            await self._ready.wait()
        frame = self._frames.popleft()
        delivery = Delivery(self._seq, self._dropped + frame.lost, frame)
        self._seq += 1
        self._dropped = 0
        return delivery


class _Audience:
    """The subscribers of one selection, and the ticks read for them since their last frame."""

    def __init__(self, selection: Selection) -> None:
        self.selection = selection
        self.subscriptions: set[Subscription] = set()
        self._pending: list[Records] = []
        self._lost = 0
        self._pumps = 0

    def take(self, records: Records, lost: int) -> None:
        """Adds the ticks of one pump, and hands out a frame when it is time."""
        self._lost += lost
        if len(records):
            self._pending.append(records)
        self._pumps += 1
        if self._pumps >= self.selection.divisor and self._pending:
            self._hand_out()

    def _hand_out(self) -> None:
        latest = self.selection.mode == "latest"
        records = self._pending[-1][-1:] if latest else np.concatenate(self._pending)
        frame = Frame(records, self.selection.signals, latest=latest, lost=0 if latest else self._lost)
        self._pending, self._lost, self._pumps = [], 0, 0
        for subscription in self.subscriptions:
            subscription.offer(frame)


class Telemetry:
    """The telemetry of one device. Belongs to the event loop's thread."""

    def __init__(self, source: TickSource) -> None:
        self._source = source
        self._audiences: dict[Selection, _Audience] = {}
        self._next_tick: int | None = None

    @contextmanager
    def subscribe(
        self, signals: Sequence[str], rate_hz: float = PUMP_HZ, mode: Mode = "latest"
    ) -> Iterator[Subscription]:
        """Frames of ``signals`` from now on.

        ``batch`` frames carry every tick since the frame before, ``latest`` the newest alone. ``rate_hz`` is
        rounded to the next ``PUMP_HZ``/n. ``Problem`` (signal-unknown) for a name that does not exist.
        """
        selection = Selection(chosen(signals), mode, max(1, round(PUMP_HZ / rate_hz)))
        audience = self._audiences.setdefault(selection, _Audience(selection))
        subscription = Subscription(selection)
        audience.subscriptions.add(subscription)
        try:
            yield subscription
        finally:
            audience.subscriptions.discard(subscription)
            if not audience.subscriptions:
                self._audiences.pop(selection, None)

    @property
    def subscribers(self) -> int:
        """How many subscriptions there are."""
        return sum(len(audience.subscriptions) for audience in self._audiences.values())

    async def run(self) -> None:
        """Pumps until cancelled."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            # A pump that was late is not made up for: the next frame simply holds more ticks.
            due = max(due + 1.0 / PUMP_HZ, loop.time())
            await asyncio.sleep(due - loop.time())
            self.pump()

    def pump(self) -> None:
        """Reads the new ticks once and hands them to everybody."""
        if not self._audiences:
            self._next_tick = None
            return
        head = self._source.head()
        if self._next_tick is None or head < self._next_tick:
            # Nobody watched before, or the servo started anew and counts from zero.
            self._next_tick = head
        batch = self._source.read(self._next_tick, READ_MAX_TICKS)
        self._next_tick = batch.first + len(batch.records)
        for audience in self._audiences.values():
            audience.take(batch.records, batch.lost)
