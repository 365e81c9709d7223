"""Why a device does not render: the core's tables of faults and interlocks, by bit and by name."""

from __future__ import annotations

from functools import cache

from hapticd import _core
from hapticd.snapshot import FaultReport, InterlockReport

OFFLINE = 1 << 0
"""The interlock of a device that is not there, in the core's order;

a device without a servo has no other to show.
"""

NOT_ENABLED = "not-enabled"
"""The interlock against pausing; it says no more than that the state machine has no such step."""


@cache
def fault_bits() -> dict[str, int]:
    """Bit of each fault by its slug."""
    return {fault["slug"]: 1 << bit for bit, fault in enumerate(_core.fault_table())}


def faults(bits: int) -> list[FaultReport]:
    """The faults in a set, in the core's order."""
    return [
        FaultReport(id=fault["slug"], severity=fault["severity"], cause=fault["cause"], cure=fault["cure"])
        for bit, fault in enumerate(_core.fault_table())
        if bits >> bit & 1
    ]


def interlocks(bits: int) -> list[InterlockReport]:
    """Every condition for enabling, those in the set as open."""
    return [interlock for interlock in _table(bits) if interlock.id != NOT_ENABLED]


def open_interlocks(bits: int) -> list[InterlockReport]:
    """The interlocks in the set: what stands against a request, whichever it was."""
    return [interlock for interlock in _table(bits) if not interlock.ok]


def _table(bits: int) -> list[InterlockReport]:
    return [
        InterlockReport(id=entry["slug"], ok=not bits >> bit & 1, why=entry["why"], cure=entry["cure"])
        for bit, entry in enumerate(_core.interlock_table())
    ]
