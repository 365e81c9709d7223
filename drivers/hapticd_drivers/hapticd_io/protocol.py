"""What the frames carry, to and from bytes (docs/io-frame.md §3 to §6). Little-endian, no I/O, no clock."""

from __future__ import annotations

from enum import IntEnum
from struct import Struct
from typing import Final, NamedTuple

AO_CHANNELS: Final = 8
AO_FULL_SCALE: Final = 32767
WATCHDOG_UNIT_S: Final = 100e-6

STATUS_ENABLED: Final = 1 << 0
STATUS_LIVE: Final = 1 << 1
STATUS_WATCHDOG_ARMED: Final = 1 << 2
STATUS_ESTOP: Final = 1 << 3
STATUS_AO_CLAMPED: Final = 1 << 8
STATUS_ENCODER_ERROR: Final = 1 << 9
STATUS_LATE_COMMAND: Final = 1 << 10
STATUS_ZEROED: Final = 1 << 11
STATUS_SAFE: Final = 1 << 15

FAULT_WATCHDOG: Final = 1 << 0
FAULT_ESTOP: Final = 1 << 1
FAULT_AMPLIFIERS: Final = 0b1111 << 2
FAULT_SUPPLY: Final = 0b11 << 6
FAULT_TEMPERATURE: Final = 1 << 8
FAULT_CONFIG: Final = 1 << 9
FAULT_CRC_STORM: Final = 1 << 10
FAULT_HARDWARE: Final = 1 << 15

ENABLE_GLOBAL: Final = 1 << 15
CONTROL_CLEAR_FAULTS: Final = 1 << 0
CONTROL_DESCRIBE: Final = 1 << 1
CONTROL_AT_NEXT_TICK: Final = 1 << 2

UNIT_VOLT: Final = 1
UNIT_MILLIAMPERE: Final = 2

_STATE: Final = Struct("<IHH4i8hHH4hH")
_STATE_MIN: Final = Struct("<IHH3iH")
_COMMAND: Final = Struct("<HH8hHHHB3x")
_DESCRIPTION: Final = Struct("<BBBBBBHHH4s8HHBB8s10s")
_CONFIG: Final = Struct("<BBHii")
_REFUSAL: Final = Struct("<HBB")


class State(NamedTuple):
    """STATE: one latch of the board. Analogue values in LSB, `command_age` in 10 µs."""

    t_us: int
    status: int = 0
    fault: int = 0
    counts: tuple[int, ...] = (0,) * 4
    analog_in: tuple[int, ...] = (0,) * 8
    digital_in: int = 0
    command_age: int = 0xFFFF
    analog_out: tuple[int, ...] = (0,) * 4
    supply_mv: int = 0

    def pack(self) -> bytes:
        """Payload bytes."""
        return _STATE.pack(
            *self[:3], *self.counts, *self.analog_in, *self[5:7], *self.analog_out, self.supply_mv
        )

    @classmethod
    def unpack(cls, payload: bytes) -> State:
        """From the payload of a STATE frame."""
        v = _STATE.unpack(payload)
        return cls(v[0], v[1], v[2], v[3:7], v[7:15], v[15], v[16], v[17:21], v[21])


class StateMin(NamedTuple):
    """STATE_MIN: a latch without analogue values, for slow UARTs."""

    t_us: int
    status: int
    fault: int
    counts: tuple[int, ...]
    digital_in: int

    def pack(self) -> bytes:
        """Payload bytes."""
        return _STATE_MIN.pack(*self[:3], *self.counts, self.digital_in)

    @classmethod
    def unpack(cls, payload: bytes) -> StateMin:
        """From the payload of a STATE_MIN frame."""
        v = _STATE_MIN.unpack(payload)
        return cls(v[0], v[1], v[2], v[3:6], v[6])


class Command(NamedTuple):
    """COMMAND: outputs in LSB (±32767 is full scale) and how long they stay valid (100 µs units)."""

    watchdog: int = 0
    enable: int = 0
    analog_out: tuple[int, ...] = (0,) * AO_CHANNELS
    digital_out: int = 0
    digital_mask: int = 0
    control: int = 0
    zero_mask: int = 0

    def pack(self) -> bytes:
        """Payload bytes."""
        return _COMMAND.pack(self[0], self[1], *self[2], *self[3:])

    @classmethod
    def unpack(cls, payload: bytes) -> Command:
        """From the payload of a COMMAND frame."""
        v = _COMMAND.unpack(payload)
        return cls(v[0], v[1], v[2:10], *v[10:])


class Description(NamedTuple):
    """DESCRIBE_RSP: what the board has. Full scales in mV or mA, per output; one for all inputs."""

    encoders: int
    analog_in: int
    analog_out: int
    digital_in: int
    digital_out: int
    capabilities: int
    tick_max_hz: int
    firmware: int
    watchdog_max: int
    ao_units: tuple[int, ...]
    ao_full_scale: tuple[int, ...]
    ai_full_scale_mv: int
    ai_bits: int
    index_flags: int
    uid: bytes
    name: str

    def pack(self) -> bytes:
        """Payload bytes."""
        units = bytes(
            low | high << 4 for low, high in zip(self.ao_units[::2], self.ao_units[1::2], strict=True)
        )
        name = self.name.encode("ascii").ljust(10)
        return _DESCRIPTION.pack(*self[:9], units, *self.ao_full_scale, *self[11:14], self.uid, name)

    @classmethod
    def unpack(cls, payload: bytes) -> Description:
        """From the payload of a DESCRIBE_RSP frame."""
        v = _DESCRIPTION.unpack(payload)
        units = tuple(nibble for byte in v[9] for nibble in (byte & 0xF, byte >> 4))
        name = v[22].decode("ascii", "replace").rstrip(" \0")
        return cls._make((*v[:9], units, v[10:18], *v[18:22], name))

    def ai_volts_per_lsb(self) -> float:
        """Scale of the analogue inputs, V per LSB; the converter is bipolar."""
        return self.ai_full_scale_mv * 1e-3 / (1 << (self.ai_bits - 1))


class Item(IntEnum):
    """CONFIG items."""

    WATCHDOG = 1  # a: timeout, 100 µs
    TICK = 2  # a: rate, Hz; 0 is host-paced, then b: the rate the host intends, Hz
    AO_CLAMP = 3  # a, b: lowest and highest, LSB
    AO_SAFE = 4  # a: value while safe, LSB
    AO_SLEW = 5  # a: largest change per tick, LSB; 0 is unlimited


class Result(IntEnum):
    """Result codes of CONFIG_ACK."""

    OK = 0
    UNKNOWN_ITEM = 1
    NO_SUCH_CHANNEL = 2
    OUT_OF_RANGE = 3
    OUTPUTS_LIVE = 4


class Config(NamedTuple):
    """CONFIG and its CONFIG_ACK: one setting; `result` is zero in the request."""

    item: int
    channel: int = 0
    result: int = 0
    a: int = 0
    b: int = 0

    def pack(self) -> bytes:
        """Payload bytes."""
        return _CONFIG.pack(*self)

    @classmethod
    def unpack(cls, payload: bytes) -> Config:
        """From the payload of a CONFIG or CONFIG_ACK frame."""
        return cls(*_CONFIG.unpack(payload))


class Refusal(NamedTuple):
    """NAK: a frame that was understood and refused."""

    seq: int
    kind: int
    reason: int

    def pack(self) -> bytes:
        """Payload bytes."""
        return _REFUSAL.pack(*self)

    @classmethod
    def unpack(cls, payload: bytes) -> Refusal:
        """From the payload of a NAK frame."""
        return cls(*_REFUSAL.unpack(payload))
