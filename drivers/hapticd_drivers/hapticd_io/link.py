"""One end of a serial link: frames to stuffed bytes and back, with sequence numbers. No I/O, no clock."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from hapticd_drivers import cobs
from hapticd_drivers.hapticd_io.frame import (
    FLAG_RESYNC,
    FRAME_MAX_BYTES,
    ChecksumError,
    Frame,
    FrameError,
    Kind,
    decode_frame,
    encode_frame,
)

STUFFED_MAX_BYTES: Final = FRAME_MAX_BYTES + 1
"""Longest stuffed frame, without its delimiter."""


@dataclass(slots=True)
class LinkCounters:
    """What came off the wire since the link was made."""

    frames: int = 0
    checksum_errors: int = 0
    malformed: int = 0


@dataclass(slots=True)
class Link:
    """Keeps what one end has to remember: its own counter, the peer's, and the half of a frame."""

    counters: LinkCounters = field(default_factory=LinkCounters)
    _started: bool = False
    _seq: int = 0
    _ack: int = 0
    _partial: bytes = b""
    _cut: bool = False

    def send(self, kind: Kind, payload: bytes = b"") -> bytes:
        """The next frame of this end, stuffed; the first one says that the counter starts."""
        flags = 0 if self._started else FLAG_RESYNC
        self._started = True
        self._seq = self._seq + 1 & 0xFFFF
        return cobs.encode(encode_frame(kind, self._seq, self._ack, payload, flags))

    @property
    def seq(self) -> int:
        """Counter of the last frame sent."""
        return self._seq

    def skip_rest(self) -> None:
        """Bytes were dropped: up to the next delimiter may come the rest of a frame, which is no error."""
        self._partial, self._cut = b"", True

    def receive(self, chunk: bytes) -> list[Frame]:
        """The good frames that `chunk` completes; everything else is counted and dropped."""
        *stuffed, self._partial = (self._partial + chunk).split(cobs.DELIMITER)
        frames = []
        for part in stuffed:
            if part and (frame := self._decode(part)):
                frames.append(frame)
            self._cut = False
        if len(self._partial) > STUFFED_MAX_BYTES:
            self.counters.malformed += not self._cut
            self.skip_rest()
        return frames

    def _decode(self, stuffed: bytes) -> Frame | None:
        try:
            frame = decode_frame(cobs.decode(stuffed))
        except ChecksumError:
            self.counters.checksum_errors += not self._cut
            return None
        except (FrameError, cobs.StuffingError):
            self.counters.malformed += not self._cut
            return None
        self.counters.frames += 1
        self._ack = frame.seq
        return frame
