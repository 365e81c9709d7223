"""Options of the driver, as the configuration file gives them: read, checked and consumed at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from hapticd_drivers.error import OptionError
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.protocol import UNIT_MILLIAMPERE, UNIT_VOLT
from hapticd_drivers.option_reader import OptionReader

AI_CHANNELS: Final = 8
AO_CHANNELS: Final = 8
ENCODER_CHANNELS: Final = 4
REPLY_SHARE: Final = 0.6
"""Share of a tick that an exchange may wait, where nothing else is said; the rest is the core's."""

PACINGS: Final = ("device", "host")

_UNITS: Final = {"v": UNIT_VOLT, "a": UNIT_MILLIAMPERE}


@dataclass(frozen=True, slots=True)
class Actuators:
    """Outputs that drive one kind of actuator, one per axis."""

    channels: tuple[int, ...]
    gains: tuple[float, ...]
    """V or N·m at the joint per V or A of the output; negative turns the actuator round."""
    unit: int
    """What the outputs must be: `UNIT_VOLT` or `UNIT_MILLIAMPERE`."""
    key: str
    """Name of the option that gave the gains."""


@dataclass(frozen=True, slots=True)
class Inputs:
    """Analogue inputs and the matrix from their volts to axes, row per axis."""

    channels: tuple[int, ...] = ()
    per_v: tuple[tuple[float, ...], ...] = ()
    bias_v: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Options:
    """Everything the driver can be told. Meanings: README.md beside this file."""

    port: str
    baud: int
    rate_hz: float
    pacing: str
    watchdog_s: float
    reply_timeout_s: float
    uid: bytes | None
    encoders: tuple[int, ...]
    motors: Actuators
    brakes: Actuators | None
    force: Inputs
    current: Inputs

    @classmethod
    def parse(cls, options: Mapping[str, Any], needs: Needs) -> Options:
        """Reads the options of a device with these needs.

        Raises:
            OptionError: a key is missing, unknown or out of range; the message names it.
        """
        take = OptionReader(options)
        rate_hz = take.number("rate_hz", 1.0, 20_000.0, 1000.0)
        parsed = cls(
            port=take.text("port"),
            baud=int(take.number("baud", 9600, 12_000_000, 921_600)),
            rate_hz=rate_hz,
            pacing=take.choice("pacing", PACINGS),
            watchdog_s=take.number("watchdog_s", 0.001, 6.5, 0.05),
            reply_timeout_s=take.number("reply_timeout_s", 0.0, 1.0 / rate_hz, REPLY_SHARE / rate_hz),
            uid=take.uid("uid"),
            encoders=take.channels("encoders", needs.axes, ENCODER_CHANNELS, range(needs.axes)),
            motors=_motors(take, needs),
            brakes=_brakes(take, needs),
            force=_force(take, needs),
            current=_current(take, needs),
        )
        take.finish()
        return parsed


def _motors(take: OptionReader, needs: Needs) -> Actuators:
    keys = ("motor_v_per_v",) if needs.spring_drive else ("motor_nm_per_v", "motor_nm_per_a")
    channels = take.channels("motors", needs.axes, AO_CHANNELS, range(needs.axes))
    return _actuators(take, channels, keys)


def _brakes(take: OptionReader, needs: Needs) -> Actuators | None:
    if not needs.brake_max_nm:
        return None
    after_motors = range(needs.axes, 2 * needs.axes)
    channels = take.channels("brakes", needs.axes, AO_CHANNELS, after_motors)
    return _actuators(take, channels, ("brake_nm_per_v", "brake_nm_per_a"))


def _actuators(take: OptionReader, channels: tuple[int, ...], keys: tuple[str, ...]) -> Actuators:
    given = [key for key in keys if key in take]
    if len(given) != 1:
        raise OptionError(f"give exactly one of {', '.join(keys)}")
    gains = take.numbers(given[0], len(channels))
    if 0.0 in gains:
        raise OptionError(f"{given[0]}: a gain of zero drives nothing")
    return Actuators(channels, gains, _UNITS[given[0][-1]], given[0])


def _force(take: OptionReader, needs: Needs) -> Inputs:
    if "force_inputs" not in take:
        return Inputs()
    channels = take.channels("force_inputs", None, AI_CHANNELS)
    matrix = take.matrix("force_n_per_v", needs.axes, len(channels))
    return Inputs(channels, matrix, take.numbers("force_bias_v", len(channels), 0.0))


def _current(take: OptionReader, needs: Needs) -> Inputs:
    if "current_inputs" not in take:
        return Inputs()
    channels = take.channels("current_inputs", needs.axes, AI_CHANNELS)
    gains = take.numbers("current_a_per_v", needs.axes)
    diagonal = tuple(
        tuple(gain if row == column else 0.0 for column in range(needs.axes))
        for row, gain in enumerate(gains)
    )
    return Inputs(channels, diagonal, (0.0,) * needs.axes)
