"""An emulated board: answers every frame as docs/io-frame.md says. No I/O; time is what it is told."""

from __future__ import annotations

from typing import Final, NamedTuple

from hapticd_drivers.hapticd_io import protocol
from hapticd_drivers.hapticd_io.enable_sequence import EnableSequence
from hapticd_drivers.hapticd_io.frame import FLAG_RESYNC, Frame, Kind
from hapticd_drivers.hapticd_io.link import Link
from hapticd_drivers.hapticd_io.output_stage import OutputStage
from hapticd_drivers.hapticd_io.protocol import Command, Config, Description, Item, Refusal, Result, State
from hapticd_drivers.hapticd_io.timeline import SEQ_BITS, wrapped_distance

NOT_SERVED: Final = 1
SUPPLY_MV: Final = 24_000
WATCHDOG_DEFAULT: Final = 500  # 50 ms
AGE_UNIT_US: Final = 10
AGE_MAX: Final = 0xFFFF
WATCHDOG_UNIT_US: Final = 100


class Latch(NamedTuple):
    """What the board's inputs hold at one instant."""

    counts: tuple[int, ...] = (0,) * 4
    analog_in: tuple[int, ...] = (0,) * 8
    status: int = 0
    """Status bits that come from inputs: E-stop, encoder error, zeroed."""
    causes: int = 0
    """Fault bits whose cause is present."""


class Board:
    """State of the board. `tick` on its own timer, `handle` for each frame, `state` to answer."""

    def __init__(self, description: Description) -> None:
        self.description = description
        self.link = Link()
        self.sequence = EnableSequence()
        self.outputs = OutputStage(description.analog_out)
        self.tick_hz = description.tick_max_hz
        self.host_paced = False
        self.latch = Latch()
        self._t_us = 0
        self._watchdog_us = WATCHDOG_DEFAULT * WATCHDOG_UNIT_US
        self._command = Command()
        self._command_seq: int | None = None
        self._command_t_us: int | None = None
        self._zeros = [0] * 4

    def tick(self, t_us: int, latch: Latch) -> None:
        """Latches the inputs and drives the outputs for the time until the next tick."""
        self._t_us, self.latch = t_us, latch
        if latch.causes:
            self.sequence.trip(latch.causes)
        if self.sequence.enabled and self._command_age_us() > self._watchdog_us:
            self.sequence.trip(protocol.FAULT_WATCHDOG)
        self._drive()

    def handle(self, frame: Frame) -> bytes:
        """Acts on one good frame and returns the reply, if any, as wire bytes."""
        if frame.flags & FLAG_RESYNC:
            self._welcome_host()
        match frame.kind:
            case Kind.COMMAND:
                return self._obey(frame)
            case Kind.DESCRIBE_REQ:
                return self._describe()
            case Kind.CONFIG:
                setting = Config.unpack(frame.payload)
                reply = setting._replace(result=self._configure(setting))
                return self.link.send(Kind.CONFIG_ACK, reply.pack())
        return self.link.send(Kind.NAK, Refusal(frame.seq, frame.kind, NOT_SERVED).pack())

    def state(self) -> bytes:
        """STATE of the last tick, as wire bytes."""
        age = AGE_MAX if self._command_t_us is None else self._command_age_us() // AGE_UNIT_US
        state = State(
            self._t_us & 0xFFFF_FFFF,
            self._status(),
            self.sequence.fault,
            tuple(count - zero for count, zero in zip(self.latch.counts, self._zeros, strict=True)),
            self.latch.analog_in,
            command_age=min(age, AGE_MAX),
            analog_out=tuple(self.outputs.values[:4]),
            supply_mv=SUPPLY_MV,
        )
        return self.link.send(Kind.STATE, state.pack())

    def _welcome_host(self) -> None:
        """Another host, or the same one anew: it finds the outputs off."""
        self._command_seq = None
        self.sequence.withdraw()
        self._drive()

    def _obey(self, frame: Frame) -> bytes:
        if self._command_seq is not None and wrapped_distance(frame.seq, self._command_seq, SEQ_BITS) <= 0:
            return b""
        command = Command.unpack(frame.payload)
        self._command, self._command_seq, self._command_t_us = command, frame.seq, self._t_us
        if command.watchdog:
            self._watchdog_us = min(command.watchdog, self.description.watchdog_max) * WATCHDOG_UNIT_US
        self.sequence.command(
            enable=command.enable & protocol.ENABLE_GLOBAL != 0,
            clear=command.control & protocol.CONTROL_CLEAR_FAULTS != 0,
            causes=self.latch.causes,
        )
        self._zero(command.zero_mask)
        if not command.control & protocol.CONTROL_AT_NEXT_TICK:
            self._drive()
        return self._describe() if command.control & protocol.CONTROL_DESCRIBE else b""

    def _describe(self) -> bytes:
        self.sequence.described = True
        return self.link.send(Kind.DESCRIBE_RSP, self.description.pack())

    def _zero(self, mask: int) -> None:
        for channel, count in enumerate(self.latch.counts):
            if mask >> channel & 1:
                self._zeros[channel] = count

    def _configure(self, setting: Config) -> Result:
        if self.sequence.live:
            return Result.OUTPUTS_LIVE
        match setting.item:
            case Item.WATCHDOG:
                return self._set_watchdog(setting.a)
            case Item.TICK:
                return self._set_tick(setting.a, setting.b)
            case Item.AO_CLAMP | Item.AO_SAFE | Item.AO_SLEW:
                return self.outputs.configure(setting)
        return Result.UNKNOWN_ITEM

    def _set_watchdog(self, timeout: int) -> Result:
        if not 0 < timeout <= self.description.watchdog_max:
            return Result.OUT_OF_RANGE
        self._watchdog_us = timeout * WATCHDOG_UNIT_US
        return Result.OK

    def _set_tick(self, rate_hz: int, intended_hz: int) -> Result:
        """The timer runs at the highest rate: every whole fraction of it can be had."""
        wanted_hz = rate_hz or intended_hz or self.description.tick_max_hz
        if wanted_hz < 0 or self.description.tick_max_hz % wanted_hz:
            return Result.OUT_OF_RANGE
        self.tick_hz, self.host_paced = wanted_hz, rate_hz == 0
        return Result.OK

    def _drive(self) -> None:
        if self.sequence.live:
            self.outputs.drive(self._command.analog_out, self._command.enable)
        else:
            self.outputs.make_safe()

    def _command_age_us(self) -> int:
        return self._t_us - (self._command_t_us or 0)

    def _status(self) -> int:
        sequence = self.sequence
        return (
            self.latch.status
            | protocol.STATUS_ENABLED * sequence.enabled
            | protocol.STATUS_LIVE * sequence.live
            | protocol.STATUS_WATCHDOG_ARMED * sequence.enabled
            | protocol.STATUS_AO_CLAMPED * self.outputs.clamped
            | protocol.STATUS_SAFE * sequence.safe
        )
