"""Which channel of the board is which axis of the device, and in what scale."""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import Final, NamedTuple

from hapticd_drivers.error import WrongDevice
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.options import Actuators, Inputs, Options
from hapticd_drivers.hapticd_io.protocol import (
    AO_CHANNELS,
    AO_FULL_SCALE,
    UNIT_MILLIAMPERE,
    UNIT_VOLT,
    Description,
)

AXES: Final = 3
MOTOR_V_AT: Final = 1
MOTOR_TORQUE_AT: Final = 4
BRAKE_TORQUE_AT: Final = 7

_UNIT_NAMES: Final = {UNIT_VOLT: "V", UNIT_MILLIAMPERE: "A"}
_REACH_TOLERANCE: Final = 1.0 - 1e-9
_COMMAND: Final = Struct("<10d")
COMMAND_BYTES: Final = _COMMAND.size


class Output(NamedTuple):
    """One analogue output: raw = value × `lsb_per_si`, kept from `low` to `high`."""

    source: int
    """Index of its value in a command of ten doubles."""
    channel: int
    lsb_per_si: float
    low: int
    high: int


class Wiring:
    """Conversions between SI and the channels of one board. Built once per connection.

    Raises:
        WrongDevice: the board lacks a channel, or an output cannot reach what the model allows.
    """

    def __init__(self, options: Options, needs: Needs, board: Description) -> None:
        _require("encoders", options.encoders, board.encoders)
        _require("force_inputs", options.force.channels, board.analog_in)
        _require("current_inputs", options.current.channels, board.analog_in)
        self.outputs = _outputs(options, needs, board)
        self.enable_mask = sum(1 << output.channel for output in self.outputs)
        self.force = Scaling(options.force, board)
        self.current = Scaling(options.current, board)
        self.encoders = options.encoders
        self._no_axes = [0] * (AXES - needs.axes)

    def to_outputs(self, command: bytes | memoryview) -> tuple[bool, list[int]]:
        """Enable and the eight raw outputs of a command of ten doubles.

        Raises:
            ValueError, OverflowError: a value is not finite.
        """
        values = _COMMAND.unpack(command)
        outputs = [0] * AO_CHANNELS
        for source, channel, lsb_per_si, low, high in self.outputs:
            raw = round(values[source] * lsb_per_si)
            outputs[channel] = low if raw < low else high if raw > high else raw
        return values[0] != 0.0, outputs

    def to_counts(self, counts: Sequence[int]) -> list[int]:
        """Counts per axis; zero for axes the device does not have."""
        return [counts[channel] for channel in self.encoders] + self._no_axes


class Scaling:
    """Analogue inputs to axes: value = offset + Σ gain · raw."""

    def __init__(self, inputs: Inputs, board: Description) -> None:
        v_per_lsb = board.ai_volts_per_lsb()
        self.channels = inputs.channels
        self.limit = (1 << (board.ai_bits - 1)) - 1
        self.gains = [[per_v * v_per_lsb for per_v in row] for row in inputs.per_v]
        self.offsets = [
            -sum(per_v * bias for per_v, bias in zip(row, inputs.bias_v, strict=True)) for row in inputs.per_v
        ]
        no_axis: list[tuple[float, list[tuple[int, float]]]] = [(0.0, [])]
        self._rows = [
            (offset, self._terms(row)) for offset, row in zip(self.offsets, self.gains, strict=True)
        ]
        self._rows += no_axis * (AXES - len(self._rows))

    def _terms(self, row: Sequence[float]) -> list[tuple[int, float]]:
        return [(channel, gain) for channel, gain in zip(self.channels, row, strict=True) if gain]

    def to_axes(self, raw: Sequence[int]) -> list[float]:
        """Values of three axes; zero for axes the device does not have."""
        values = []
        for value, terms in self._rows:
            for channel, gain in terms:
                value += gain * raw[channel]
            values.append(value)
        return values

    def saturated(self, raw: Sequence[int]) -> bool:
        """Whether an input is at the end of its range."""
        limit = self.limit
        return any(not -limit < raw[channel] < limit for channel in self.channels)


def _require(key: str, channels: tuple[int, ...], available: int) -> None:
    if channels and max(channels) >= available:
        raise WrongDevice(f"{key} names channel {max(channels)}, the board has {available}")


def _outputs(options: Options, needs: Needs, board: Description) -> list[Output]:
    motors_at = MOTOR_V_AT if needs.spring_drive else MOTOR_TORQUE_AT
    outputs = _bank(options.motors, needs.motor_max, board, motors_at, both_ways=True)
    if options.brakes is not None:
        outputs += _bank(options.brakes, needs.brake_max_nm, board, BRAKE_TORQUE_AT, both_ways=False)
    channels = [output.channel for output in outputs]
    if len(set(channels)) != len(channels):
        raise WrongDevice(f"motors and brakes share an output among {channels}")
    return outputs


def _bank(
    actuators: Actuators, largest: tuple[float, ...], board: Description, source: int, *, both_ways: bool
) -> list[Output]:
    _require(actuators.key, actuators.channels, board.analog_out)
    bank = []
    for axis, (channel, gain) in enumerate(zip(actuators.channels, actuators.gains, strict=True)):
        _check_unit(actuators, channel, board)
        full_scale = gain * board.ao_full_scale[channel] * 1e-3
        if abs(full_scale) < largest[axis] * _REACH_TOLERANCE:
            raise WrongDevice(
                f"output {channel} reaches {abs(full_scale):g}, the model allows {largest[axis]:g}: "
                f"mend {actuators.key} or lower the model's limit"
            )
        lsb_per_si = AO_FULL_SCALE / full_scale
        ends = (largest[axis] * lsb_per_si, -largest[axis] * lsb_per_si if both_ways else 0.0)
        bank.append(Output(source + axis, channel, lsb_per_si, round(min(ends)), round(max(ends))))
    return bank


def _check_unit(actuators: Actuators, channel: int, board: Description) -> None:
    unit = board.ao_units[channel]
    if unit != actuators.unit:
        raise WrongDevice(
            f"{actuators.key} wants outputs in {_UNIT_NAMES[actuators.unit]}, "
            f"output {channel} of the board is in {_UNIT_NAMES.get(unit, 'no known unit')}"
        )
