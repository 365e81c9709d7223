"""Driver of a board that speaks the hapticd I/O frame over a serial port (docs/io-frame.md)."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from hapticd_drivers.error import DeviceLost, DriverError, NoAnswer, WrongDevice
from hapticd_drivers.hapticd_io.frame import FLAG_RESYNC, Frame, Kind
from hapticd_drivers.hapticd_io.handshake import configure, describe
from hapticd_drivers.hapticd_io.link import Link
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.observation import OBSERVATION, Observer
from hapticd_drivers.hapticd_io.options import Options
from hapticd_drivers.hapticd_io.protocol import (
    CONTROL_CLEAR_FAULTS,
    ENABLE_GLOBAL,
    STATUS_SAFE,
    WATCHDOG_UNIT_S,
    Command,
    Description,
    State,
)
from hapticd_drivers.hapticd_io.timeline import SEQ_BITS, Timeline, wrapped_distance
from hapticd_drivers.hapticd_io.wiring import COMMAND_BYTES, Wiring
from hapticd_drivers.transport import ByteTransport, SerialTransport

if TYPE_CHECKING:
    from hapticd.model import Model

FRESH: Final = 0
MISSING: Final = 1
DOWN: Final = 2

BACKLOG_BYTES: Final = 256
"""A read of so much means that frames have piled up, and that there may be more of them."""

PAUSE_S: Final = 0.02
"""Without an exchange for this long whatever has arrived is dropped as old."""

REHEARSALS: Final = 20
"""Exchanges before a connection is handed over."""

SILENCE_S: Final = 1.0
"""Without a STATE for this long the connection is made anew."""


class HapticdIo:
    """One board. `connect` and `close` from a thread that may wait, `exchange` from the loop."""

    def __init__(
        self,
        options: Options,
        needs: Needs,
        transport: ByteTransport,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.identity = ""
        self._options = options
        self._needs = needs
        self._transport = transport
        self._clock = clock
        self._uid = options.uid
        self._link = Link()
        self._timeline = Timeline()
        self._watchdog = round(options.watchdog_s / WATCHDOG_UNIT_S)
        self._idle = Command(watchdog=self._watchdog).pack()
        self._clear = Command(watchdog=self._watchdog, control=CONTROL_CLEAR_FAULTS).pack()
        self._answers_at_once = options.pacing == "host"
        self._torn = False
        self._missing = 0
        self._late = 0
        self._reset()

    def _reset(self) -> None:
        """Forgets what was known about a board that may have restarted."""
        self._armed = False
        self._clearing = False
        self._blocked = True
        self._withdrawn_seq: int | None = self._link.seq
        self._alive_at = self._called_at = self._clock()

    def connect(self) -> None:
        """Opens the port, makes sure of the board, and configures it.

        Raises:
            DeviceLost, NoAnswer, WrongDevice: why it cannot be used; the port is closed again.
        """
        self.close()
        self._link = Link(self._link.counters)
        self._transport.open()
        try:
            self._set_up(describe(self._link, self._transport, self._clock))
            self._rehearse()
        except DriverError:
            self._transport.close()
            raise

    def _set_up(self, board: Description) -> None:
        if self._uid not in (None, board.uid):
            raise WrongDevice(f"board {board.uid.hex()} answers, {self._uid.hex()} is configured")
        self._wiring = Wiring(self._options, self._needs, board)
        self._observer = Observer(self._wiring)
        configure(self._link, self._transport, self._clock, self._options, self._wiring.outputs, board)
        self._uid = board.uid
        version = f"{board.firmware >> 8}.{board.firmware & 0xFF:02d}"
        self.identity = f"{board.name} {board.uid.hex()} firmware {version}"
        self._timeline.anchor(int(self._clock() * 1e9))
        self._reset()

    def _rehearse(self) -> None:
        """Some exchanges with outputs off: the first ones are slow, and the board gets its fault cleared."""
        command, observation = memoryview(bytes(COMMAND_BYTES)), memoryview(bytearray(OBSERVATION.size))
        outcomes = [self.exchange(command, observation) for _ in range(REHEARSALS)]
        if FRESH not in outcomes:
            raise NoAnswer("the board describes itself but sends no STATE")

    def exchange(self, command: memoryview, observation: memoryview) -> int:
        """Sends ten doubles, fills `observation` with the newest STATE; never waits past the tick.

        Returns:
            `FRESH`, `MISSING` (nothing new; `observation` is untouched) or `DOWN` (connect anew).
        """
        now = self._clock()
        deadline = now + self._options.reply_timeout_s
        try:
            if now - self._called_at > PAUSE_S:
                self._skip_backlog()
            self._called_at = now
            self._send(command)
            frame = self._newest(deadline)
        except DeviceLost:
            return DOWN
        if frame is None:
            self._missing += 1
            return MISSING if self._clock() - self._alive_at < SILENCE_S else DOWN
        self._alive_at = self._clock()
        state = State.unpack(frame.payload)
        self._blocked = not self._is_clear(state, frame.ack)
        self._observer.write(state, self._timeline, self._armed, observation)
        return FRESH

    def close(self) -> None:
        """Lets the port go at once; the board's watchdog makes the outputs safe."""
        self._transport.close()

    def statistics(self) -> dict[str, int]:
        """Counts since the driver was made."""
        counters = self._link.counters
        return {
            "frames": counters.frames,
            "checksum_errors": counters.checksum_errors,
            "malformed": counters.malformed,
            "lost": self._timeline.lost,
            "stale": self._timeline.stale,
            "late": self._late,
            "missing": self._missing,
        }

    def _skip_backlog(self) -> None:
        """After a pause more frames have piled up than one tick can read: begin with the next one."""
        self._transport.flush()
        self._link.skip_rest()

    def _send(self, command: memoryview) -> None:
        enable, raw = self._wiring.to_outputs(command)
        was_armed, self._armed = self._armed, enable and (self._armed or not self._blocked)
        if was_armed and not self._armed:
            self._withdraw()
        if self._armed:
            payload = Command(self._watchdog, ENABLE_GLOBAL | self._wiring.enable_mask, tuple(raw)).pack()
        else:
            # Clearing acts on the rising edge, so the bit alternates until the board is clear.
            self._clearing = self._blocked and not self._clearing
            payload = self._clear if self._clearing else self._idle
        wire = self._link.send(Kind.COMMAND, payload)
        if self._torn:
            wire = b"\0" + wire
        self._torn = self._transport.write(wire) < len(wire)

    def _withdraw(self) -> None:
        """From here on the board has to be cleared, whatever STATE is still under way."""
        self._blocked = True
        self._withdrawn_seq = self._link.seq + 1 & 0xFFFF

    def _is_clear(self, state: State, ack: int) -> bool:
        """Whether the board is free to go live, and says so with the last withdrawal behind it."""
        if self._withdrawn_seq is not None and wrapped_distance(ack, self._withdrawn_seq, SEQ_BITS) > 0:
            self._withdrawn_seq = None
        return self._withdrawn_seq is None and state.fault == 0 and not state.status & STATUS_SAFE

    def _newest(self, deadline: float) -> Frame | None:
        """The newest STATE; host-paced, the one that answers the command just sent if it comes in time."""
        newest: Frame | None = None
        wait_s = max(deadline - self._clock(), 0.0) if self._answers_at_once else 0.0
        while True:
            chunk = self._transport.read(wait_s)
            for frame in self._link.receive(chunk):
                newest = self._take(frame) or newest
            left_s = deadline - self._clock()
            backlog = len(chunk) >= BACKLOG_BYTES
            if newest is not None and not backlog and self._is_awaited(newest):
                return newest
            if left_s <= 0.0:
                self._late += newest is not None
                return newest
            wait_s = left_s

    def _is_awaited(self, frame: Frame) -> bool:
        return not self._answers_at_once or frame.ack == self._link.seq

    def _take(self, frame: Frame) -> Frame | None:
        if frame.flags & FLAG_RESYNC:
            raise DeviceLost("the board restarted")
        if frame.kind is not Kind.STATE:
            self._timeline.pass_by(frame.seq)
            return None
        return frame if self._timeline.advance(frame.seq) else None


def create(options: Mapping[str, Any], model: Model) -> HapticdIo:
    """The driver of a configured device.

    Raises:
        OptionError: an option is missing, unknown or out of range.
    """
    needs = Needs.of(model.device_json)
    parsed = Options.parse(options, needs)
    return HapticdIo(parsed, needs, SerialTransport(parsed.port, parsed.baud))
