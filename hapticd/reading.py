"""One tick record, in the words of the API."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from hapticd.record import record_dtype
from hapticd.snapshot import DeviceState, Flags

STATES: tuple[DeviceState, ...] = ("offline", "disabled", "enabled", "paused", "fault")
"""By the number in the record."""

FLAGS = ("homed", "busy", "estop", "fading", "fresh", "contact")
"""Bits of the record's flags, lowest first."""

LIMITS = ("voltage", "motor_torque", "tip_force", "slew", "thermal", "brake", "singularity", "non_finite")
"""Bits of the record's limits, lowest first."""


class Reading:
    """What one tick knew."""

    def __init__(self, record: np.void) -> None:
        self._record = record

    @classmethod
    def of(cls, record: bytes) -> Reading | None:
        """The reading in the bytes of one record; None when there is none yet."""
        return cls(np.frombuffer(record, record_dtype())[0]) if record else None

    @property
    def state(self) -> DeviceState:
        return STATES[self.integer("state")]

    @property
    def flags(self) -> Flags:
        named = _named(self.integer("flags"), FLAGS)
        return Flags(**{name: name in named for name in Flags.model_fields})

    @property
    def limits(self) -> list[str]:
        """Names of the limits that acted in this tick."""
        return _named(self.integer("limits"), LIMITS)

    def integer(self, name: str) -> int:
        """An integer field."""
        return int(self._record[name])

    def number(self, name: str) -> float:
        """A scalar field."""
        return float(self._record[name])

    def vector(self, name: str, length: int) -> list[float]:
        """The first ``length`` components of a vector field."""
        return cast("list[float]", np.asarray(self._record[name])[:length].tolist())


def _named(bits: int, names: tuple[str, ...]) -> list[str]:
    return [name for bit, name in enumerate(names) if bits >> bit & 1]


def records_of(raw: bytes) -> np.ndarray[Any, np.dtype[np.void]]:
    """Whole records as a structured array."""
    return np.frombuffer(raw, record_dtype())
