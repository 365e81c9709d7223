"""The wires between an emulated board and the plant: the driver's wiring, seen from the other end."""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import Final

import numpy as np

from hapticd_drivers.hapticd_io import protocol
from hapticd_drivers.hapticd_io.board import Latch
from hapticd_drivers.hapticd_io.observation import (
    AMPLIFIER_FAULT,
    ENCODER_ERROR,
    ESTOP_INPUT,
    HOMED,
    OBSERVATION,
)
from hapticd_drivers.hapticd_io.wiring import Scaling, Wiring

_COMMAND: Final = Struct("<10d")
_I32: Final = 1 << 32
_FAULT_AMPLIFIER_0: Final = 1 << 2


class PlantWiring:
    """Raw outputs to a plant's command; a plant's observation to raw inputs."""

    def __init__(self, wiring: Wiring) -> None:
        self._outputs = wiring.outputs
        self._encoders = wiring.encoders
        self._force = _Sensors(wiring.force)
        self._current = _Sensors(wiring.current)

    def to_command(self, live: bool, raw: Sequence[int]) -> bytes:
        """Ten doubles for the plant; all zero while the outputs are not live."""
        values = [0.0] * 10
        if live:
            values[0] = 1.0
            for source, channel, lsb_per_si, _, _ in self._outputs:
                values[source] = raw[channel] / lsb_per_si
        return _COMMAND.pack(*values)

    def to_latch(self, observation: bytes, estop: bool) -> Latch:
        """What the board's inputs hold. `estop`: the operator has pressed the button."""
        _, _, c0, c1, c2, f0, f1, f2, _, i0, i1, i2, status = OBSERVATION.unpack(observation)
        counts = [0] * 4
        for channel, count in zip(self._encoders, (c0, c1, c2), strict=False):
            counts[channel] = (count + _I32 // 2) % _I32 - _I32 // 2
        analog_in = [0] * 8
        self._force.write(analog_in, (f0, f1, f2))
        self._current.write(analog_in, (i0, i1, i2))
        estop = estop or status & ESTOP_INPUT != 0
        amplifier = status & AMPLIFIER_FAULT != 0
        return Latch(
            tuple(counts),
            tuple(analog_in),
            protocol.STATUS_ESTOP * estop
            | protocol.STATUS_ENCODER_ERROR * (status & ENCODER_ERROR != 0)
            | protocol.STATUS_ZEROED * (status & HOMED != 0),
            protocol.FAULT_ESTOP * estop | _FAULT_AMPLIFIER_0 * amplifier,
        )


class _Sensors:
    """The inverse of a `Scaling`: the smallest raw values that read as given."""

    def __init__(self, scaling: Scaling) -> None:
        gains = np.array(scaling.gains).reshape(len(scaling.gains), len(scaling.channels))
        self._channels = scaling.channels
        self._inverse = np.linalg.pinv(gains).tolist()
        self._offsets = scaling.offsets
        self._limit = scaling.limit

    def write(self, analog_in: list[int], values: Sequence[float]) -> None:
        """Sets this sensor's channels."""
        wanted = [value - offset for value, offset in zip(values, self._offsets, strict=False)]
        for channel, row in zip(self._channels, self._inverse, strict=True):
            raw = sum(gain * value for gain, value in zip(row, wanted, strict=True))
            analog_in[channel] = round(min(max(raw, -self._limit), self._limit))
