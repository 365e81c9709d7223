"""From a STATE frame to the observation that the control core reads."""

from __future__ import annotations

from struct import Struct
from typing import Final

from hapticd_drivers.hapticd_io import protocol
from hapticd_drivers.hapticd_io.protocol import State
from hapticd_drivers.hapticd_io.timeline import Timeline
from hapticd_drivers.hapticd_io.wiring import Wiring

FORCE_PRESENT: Final = 1 << 0
CURRENT_PRESENT: Final = 1 << 1
OUTPUTS_LIVE: Final = 1 << 2
ESTOP_INPUT: Final = 1 << 3
AMPLIFIER_FAULT: Final = 1 << 4
BOARD_WATCHDOG: Final = 1 << 5
ENCODER_ERROR: Final = 1 << 6
SENSOR_SATURATED: Final = 1 << 7
HOMED: Final = 1 << 8

OBSERVATION: Final = Struct("<QQ3q3dd3dQ")
"""seq, t_device_ns, counts, force_n, force_age_s, motor_current_a, status."""

_FROM_STATUS: Final = (
    (protocol.STATUS_LIVE, OUTPUTS_LIVE),
    (protocol.STATUS_ESTOP, ESTOP_INPUT),
    (protocol.STATUS_ENCODER_ERROR, ENCODER_ERROR),
    (protocol.STATUS_ZEROED, HOMED),
)
_AMPLIFIER: Final = (
    protocol.FAULT_AMPLIFIERS
    | protocol.FAULT_SUPPLY
    | protocol.FAULT_TEMPERATURE
    | protocol.FAULT_CONFIG
    | protocol.FAULT_HARDWARE
)
_WATCHDOG: Final = protocol.FAULT_WATCHDOG | protocol.FAULT_CRC_STORM
_LATCH_AGE_S: Final = 0.0  # analogue inputs are latched together with the encoders


class Observer:
    """Writes observations of one board."""

    def __init__(self, wiring: Wiring) -> None:
        self._wiring = wiring
        self._present = FORCE_PRESENT if wiring.force.channels else 0
        self._present |= CURRENT_PRESENT if wiring.current.channels else 0

    def write(self, state: State, timeline: Timeline, armed: bool, observation: memoryview) -> None:
        """Fills `observation`. `armed`: the driver has asked for live outputs."""
        wiring, analog_in = self._wiring, state.analog_in
        status = self._present | status_bits(state, armed)
        if wiring.force.saturated(analog_in):
            status |= SENSOR_SATURATED
        OBSERVATION.pack_into(
            observation,
            0,
            timeline.seq,
            timeline.read_clock(state.t_us),
            *wiring.to_counts(state.counts),
            *wiring.force.to_axes(analog_in),
            _LATCH_AGE_S,
            *wiring.current.to_axes(analog_in),
            status,
        )


def status_bits(state: State, armed: bool) -> int:
    """Status bits of the observation.

    An expired watchdog is worth telling only when outputs were asked for: a board that has just
    been switched on, or whose host rested, reports one too.
    """
    bits = 0
    for mask, bit in _FROM_STATUS:
        if state.status & mask:
            bits |= bit
    if state.fault:
        bits |= ESTOP_INPUT if state.fault & protocol.FAULT_ESTOP else 0
        bits |= AMPLIFIER_FAULT if state.fault & _AMPLIFIER else 0
        bits |= BOARD_WATCHDOG if armed and state.fault & _WATCHDOG else 0
    return bits
