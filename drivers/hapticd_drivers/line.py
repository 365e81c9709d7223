"""A bad cable: loses, damages, delays, swaps and doubles frames, by a seed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any, Final

from hapticd_drivers.cobs import DELIMITER
from hapticd_drivers.error import OptionError

DELAY_MAX_S: Final = 10.0


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of time, s since the emulator started; for ever where `duration_s` is infinite."""

    start_s: float = float("inf")
    duration_s: float = float("inf")

    def covers(self, t_s: float) -> bool:
        """Whether `t_s` lies in the span."""
        return self.start_s <= t_s < self.start_s + self.duration_s


@dataclass(frozen=True, slots=True)
class LineFaults:
    """What is wrong with the line. Fractions are per frame, in each direction."""

    lose: float = 0.0
    corrupt: float = 0.0
    duplicate: float = 0.0
    reorder: float = 0.0
    delay_s: float = 0.0
    """Longest delay of a frame; the order is kept."""
    mute: Span = Span()
    """The board sends nothing."""
    unplug: Span = Span()
    """The port is gone."""

    @classmethod
    def parse(cls, spec: str) -> LineFaults:
        """From `lose=0.01,delay=0.002,mute=5+0.5,unplug=10`: times are START+DURATION, s.

        Raises:
            OptionError: names what is wrong.
        """
        given = {}
        for part in filter(None, spec.split(",")):
            name, _, text = part.partition("=")
            if name not in _FIELDS:
                raise OptionError(f"unknown fault {name}: choose from {', '.join(_FIELDS)}")
            field, read = _FIELDS[name]
            given[field] = read(name, text)
        return cls(**given)


def _fraction(name: str, text: str) -> float:
    numbers = _numbers(text)
    if len(numbers) != 1 or not 0.0 <= numbers[0] <= 1.0:
        raise OptionError(f"{name}={text}: give a fraction from 0 to 1")
    return numbers[0]


def _seconds(name: str, text: str) -> float:
    numbers = _numbers(text)
    if len(numbers) != 1 or not 0.0 <= numbers[0] <= DELAY_MAX_S:
        raise OptionError(f"{name}={text}: give seconds from 0 to {DELAY_MAX_S:g}")
    return numbers[0]


def _span(name: str, text: str) -> Span:
    numbers = _numbers(text)
    if len(numbers) not in (1, 2) or not min(numbers) >= 0.0:
        raise OptionError(f"{name}={text}: give START or START+DURATION in seconds")
    return Span(*numbers)


def _numbers(text: str) -> list[float]:
    try:
        return [float(number) for number in text.split("+")]
    except ValueError:
        return []


_FIELDS: Final[dict[str, tuple[str, Callable[[str, str], Any]]]] = {
    "lose": ("lose", _fraction),
    "corrupt": ("corrupt", _fraction),
    "duplicate": ("duplicate", _fraction),
    "reorder": ("reorder", _fraction),
    "delay": ("delay_s", _seconds),
    "mute": ("mute", _span),
    "unplug": ("unplug", _span),
}


class Line:
    """One direction of the cable."""

    def __init__(self, faults: LineFaults, seed: int) -> None:
        self._faults = faults
        self._good = not any((faults.lose, faults.corrupt, faults.duplicate, faults.reorder, faults.delay_s))
        self._random = Random(seed)
        self._queue: deque[tuple[float, bytes]] = deque()
        self._swapped = b""
        self._partial = b""

    def push(self, data: bytes, now_s: float) -> None:
        """Puts bytes in at one end; on a bad cable they travel frame by frame."""
        if self._good:
            self._queue.append((now_s, data))
            return
        *frames, self._partial = (self._partial + data).split(DELIMITER)
        for frame in frames:
            self._carry(frame + DELIMITER, now_s)

    def pull(self, now_s: float) -> bytes:
        """Takes out at the other end what has arrived."""
        arrived = []
        while self._queue and self._queue[0][0] <= now_s:
            arrived.append(self._queue.popleft()[1])
        return b"".join(arrived)

    def next_s(self) -> float:
        """When the next frame arrives; infinity when none is under way."""
        return self._queue[0][0] if self._queue else float("inf")

    def _carry(self, frame: bytes, now_s: float) -> None:
        faults, chance = self._faults, self._random.random
        if faults.lose and chance() < faults.lose:
            return
        if faults.corrupt and chance() < faults.corrupt:
            frame = self._damaged(frame)
        if faults.reorder and not self._swapped and chance() < faults.reorder:
            self._swapped = frame
            return
        copies = 2 if faults.duplicate and chance() < faults.duplicate else 1
        self._enqueue(frame * copies + self._swapped, now_s)
        self._swapped = b""

    def _enqueue(self, data: bytes, now_s: float) -> None:
        due_s = now_s + (self._random.uniform(0.0, self._faults.delay_s) if self._faults.delay_s else 0.0)
        last_s = self._queue[-1][0] if self._queue else due_s
        self._queue.append((max(due_s, last_s), data))

    def _damaged(self, frame: bytes) -> bytes:
        damaged = bytearray(frame)
        damaged[self._random.randrange(len(frame))] ^= 1 << self._random.randrange(8)
        return bytes(damaged)
