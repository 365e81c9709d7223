"""Runs an emulated serial device behind a pseudo-terminal, in real time, until told to stop."""

from __future__ import annotations

import gc
import json
import os
import time
from collections.abc import Callable
from select import select
from typing import Any, Final, Protocol

from hapticd_drivers.error import OptionError
from hapticd_drivers.line import Line, LineFaults
from hapticd_drivers.pseudo_terminal import PseudoTerminal

IDLE_S: Final = 0.05
"""Longest sleep, so that a request to stop is seen."""


class EmulatedDevice(Protocol):
    """The device itself: bytes in, bytes out, at the times it is told."""

    def start(self, now_s: float) -> None:
        """Power-up."""

    def receive(self, data: bytes, now_s: float) -> bytes:
        """Takes bytes off the line and returns what it answers."""

    def advance(self, now_s: float) -> bytes:
        """Lets time pass until `now_s` and returns what it sends of its own accord."""

    def next_s(self) -> float:
        """When it wants to be advanced next."""

    def answers(self) -> bool:
        """Whether it reacts to what it receives at once; otherwise when it is advanced."""

    def control(self, message: dict[str, Any]) -> None:
        """Acts on a message of the operator. Raises `OptionError`, ValueError."""


class Emulation:
    """A device, its cable and its port."""

    def __init__(
        self, device: EmulatedDevice, terminal: PseudoTerminal, faults: LineFaults, seed: int
    ) -> None:
        self._device = device
        self._terminal = terminal
        self._seed = seed
        self._set_faults(faults)
        self._plugged = True
        self._typed = b""

    def __enter__(self) -> Emulation:
        return self

    def __exit__(self, *_: object) -> None:
        self._terminal.remove_link()
        self._terminal.close()

    def _set_faults(self, faults: LineFaults) -> None:
        self._faults = faults
        self._to_host = Line(faults, self._seed)
        self._to_device = Line(faults, self._seed + 1)

    def run(
        self, commands_fd: int | None, stopped: Callable[[], bool], refused: Callable[[str], None]
    ) -> None:
        """Serves until `stopped`.

        Lines of JSON on `commands_fd` go to the device; `refused` is told about bad ones.
        """
        gc.freeze()  # a collection over everything imported would hold a frame up for tens of milliseconds
        start_s = time.monotonic()
        self._device.start(0.0)
        while not stopped():
            now_s = time.monotonic() - start_s
            ready = self._wait(commands_fd, max(self._next_s() - now_s, 0.0))
            now_s = time.monotonic() - start_s
            self._plug(now_s)
            self._exchange(self._terminal.read(), now_s)
            if commands_fd in ready and not self._listen(commands_fd, refused):
                commands_fd = None

    def _wait(self, commands_fd: int | None, timeout_s: float) -> list[int]:
        """Sleeps until something is to be done; returns what can be read.

        The port is watched only by a device that answers: to look at it may take the kernel longer
        than a tick (see `SerialTransport.read`), and a device with a timer of its own must not wait.
        """
        port = self._terminal.fd if self._device.answers() else None
        watched = [fd for fd in (port, commands_fd) if fd is not None and fd >= 0]
        return select(watched, (), (), min(timeout_s, IDLE_S))[0]

    def _next_s(self) -> float:
        return min(self._device.next_s(), self._to_host.next_s(), self._to_device.next_s())

    def _plug(self, now_s: float) -> None:
        if self._plugged == self._faults.unplug.covers(now_s):
            self._plugged = not self._plugged
            if self._plugged:
                self._terminal.open()
            else:
                self._terminal.close()

    def _exchange(self, data: bytes, now_s: float) -> None:
        self._to_device.push(data, now_s)
        self._send(self._device.receive(self._to_device.pull(now_s), now_s), now_s)
        self._send(self._device.advance(now_s), now_s)

    def _send(self, data: bytes, now_s: float) -> None:
        if not self._faults.mute.covers(now_s):
            self._to_host.push(data, now_s)
        arrived = self._to_host.pull(now_s)
        if arrived and self._plugged:
            self._terminal.write(arrived)

    def _listen(self, commands_fd: int | None, refused: Callable[[str], None]) -> bool:
        """Reads what was typed; False at its end."""
        chunk = os.read(commands_fd, 4096) if commands_fd is not None else b""
        *lines, self._typed = (self._typed + chunk).split(b"\n")
        for line in filter(None, map(bytes.strip, lines)):
            try:
                self._obey(json.loads(line))
            except ValueError as error:  # bad JSON, bad values, OptionError
                refused(str(error))
        return bool(chunk)

    def _obey(self, message: Any) -> None:
        if not isinstance(message, dict):
            raise OptionError('give an object, such as {"hand": {"type": "free"}}')
        rest = dict(message)
        if "faults" in rest:
            self._set_faults(LineFaults.parse(str(rest.pop("faults"))))
        if rest:
            self._device.control(rest)
