"""The board's counters without their wraps: frame number and device clock."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

SEQ_BITS: Final = 16
CLOCK_BITS: Final = 32


@dataclass(slots=True)
class Timeline:
    """Frame number and clock of the newest STATE, rising over wraps and over reconnections.

    A lost frame leaves a gap in `seq`. Frames of other types take a number on the wire but leave none here.
    """

    seq: int = 0
    t_ns: int = 0
    lost: int = 0
    stale: int = 0
    _wire_seq: int | None = None
    _wire_t_us: int | None = None

    def anchor(self, t_mono_ns: int) -> None:
        """Begins anew after a connection: the next frame is the next number, at the host's time."""
        self._wire_seq = self._wire_t_us = None
        self.t_ns = max(self.t_ns + 1, t_mono_ns)

    def pass_by(self, wire_seq: int) -> None:
        """Takes note of a frame that is not a STATE."""
        if self._move(wire_seq):
            self.seq -= 1

    def advance(self, wire_seq: int) -> bool:
        """Takes a STATE; False when it is a duplicate or older than what came before."""
        moved = self._move(wire_seq)
        self.stale += not moved
        return moved

    def read_clock(self, wire_t_us: int) -> int:
        """Device time of the newest STATE, ns; goes backwards only if the board's clock does."""
        if self._wire_t_us is not None:
            self.t_ns = max(self.t_ns + 1000 * wrapped_distance(wire_t_us, self._wire_t_us, CLOCK_BITS), 0)
        self._wire_t_us = wire_t_us
        return self.t_ns

    def _move(self, wire_seq: int) -> bool:
        ahead = 1 if self._wire_seq is None else wrapped_distance(wire_seq, self._wire_seq, SEQ_BITS)
        if ahead <= 0:
            return False
        self._wire_seq = wire_seq
        self.seq += ahead
        self.lost += ahead - 1
        return True


def wrapped_distance(newer: int, older: int, bits: int) -> int:
    """Signed distance from `older` to `newer` on a counter of `bits` bits that wraps."""
    half = 1 << (bits - 1)
    return (newer - older + half & (1 << bits) - 1) - half
