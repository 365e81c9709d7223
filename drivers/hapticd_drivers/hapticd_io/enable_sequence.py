"""When a board may drive its outputs (docs/io-frame.md §7, rules 3 and 4). Pure: no clock, no bytes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from hapticd_drivers.hapticd_io.protocol import FAULT_WATCHDOG

COMMANDS_TO_LIVE: Final = 3


@dataclass(slots=True)
class EnableSequence:
    """From safe over enabled to live, and back at the first fault.

    Live is reached only from: described, no fault, not safe, enable 0 → 1, three commands. `fault`
    starts with the watchdog's bit, as a reset counts as an expired watchdog.
    """

    described: bool = False
    fault: int = FAULT_WATCHDOG
    safe: bool = False
    enabled: bool = False
    live: bool = False
    _may_rise: bool = False
    _streak: int = 0
    _clear: bool = False

    def command(self, *, enable: bool, clear: bool, causes: int) -> None:
        """Takes one newer COMMAND. `causes` are the fault bits whose cause persists."""
        if clear and not self._clear and not enable:
            self.fault = causes
            self.safe = self.safe and causes != 0
        self._clear = clear
        if not enable:
            self.withdraw()
            self._may_rise = self.described and not self.fault and not self.safe
        elif self._may_rise:
            self.enabled = True
            self._streak += 1
            self.live = self._streak >= COMMANDS_TO_LIVE

    def trip(self, faults: int) -> None:
        """Latches faults; outputs are safe from here on."""
        self.fault |= faults
        self.withdraw()

    def withdraw(self) -> None:
        """Outputs are off from here on; enable has to rise anew."""
        self._may_rise = False
        self.safe = self.safe or self.live
        self.enabled = self.live = False
        self._streak = 0
