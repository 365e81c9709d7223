"""The board that suits a device: what it describes itself as, and the options that fit it."""

from __future__ import annotations

import hashlib
from typing import Any, Final

from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.protocol import AO_CHANNELS, UNIT_MILLIAMPERE, UNIT_VOLT, Description

HEADROOM: Final = 1.25
"""Full scale of every channel over the device's largest value."""

AI_FULL_SCALE_V: Final = 10.0
AO_FULL_SCALE_V: Final = 10.0
AI_BITS: Final = 16


def emulated_board(needs: Needs, rate_hz: int, name: str, seed: int) -> Description:
    """A board that suits a device: every channel reaches `HEADROOM` over what is needed."""
    motor_scale = (
        round(HEADROOM * 1e3 * max(needs.motor_max)) if needs.spring_drive else round(AO_FULL_SCALE_V * 1e3)
    )
    units = [UNIT_VOLT] * needs.axes + [UNIT_MILLIAMPERE] * len(needs.brake_max_nm)
    scales = [motor_scale] * needs.axes + [1000] * len(needs.brake_max_nm)
    spare = AO_CHANNELS - len(units)
    return Description(
        encoders=4,
        analog_in=8,
        analog_out=len(units),
        digital_in=16,
        digital_out=8,
        capabilities=0b0011,
        tick_max_hz=rate_hz,
        firmware=0x0100,
        watchdog_max=10_000,
        ao_units=(*units, *[0] * spare),
        ao_full_scale=(*scales, *[0] * spare),
        ai_full_scale_mv=round(AI_FULL_SCALE_V * 1e3),
        ai_bits=AI_BITS,
        index_flags=0,
        uid=hashlib.sha256(f"{name} {seed}".encode()).digest()[:8],
        name="hhd-io" if needs.brake_max_nm else "phantom-io",
    )


def emulated_options(needs: Needs, board: Description, port: str) -> dict[str, Any]:
    """The driver's options for that board, as they belong into the configuration file."""
    options: dict[str, Any] = {"port": port, "rate_hz": board.tick_max_hz, "uid": board.uid.hex()}
    if needs.spring_drive:
        options["motor_v_per_v"] = [1.0] * needs.axes
    else:
        options["motor_nm_per_v"] = [HEADROOM * largest / AO_FULL_SCALE_V for largest in needs.motor_max]
    if needs.brake_max_nm:
        options["brake_nm_per_a"] = [HEADROOM * largest for largest in needs.brake_max_nm]
    if needs.sensor_force_n:
        n_per_v = HEADROOM * needs.sensor_force_n / AI_FULL_SCALE_V
        options["force_inputs"] = list(range(needs.axes))
        options["force_n_per_v"] = [
            [n_per_v if row == column else 0.0 for column in range(needs.axes)] for row in range(needs.axes)
        ]
    return options
