"""COBS byte stuffing: a frame without a single 0x00, so that 0x00 can end it (Cheshire & Baker, 1999)."""

from __future__ import annotations

from typing import Final

DELIMITER: Final = b"\0"
"""Ends every stuffed frame."""

FRAME_MAX_BYTES: Final = 253
"""Longest frame taken here: no block is ever full, so the 0xFF code never occurs."""

_CODES: Final = tuple(bytes([length]) for length in range(256))


class StuffingError(ValueError):
    """A stuffed frame that no encoder makes."""


def encode(frame: bytes) -> bytes:
    """Stuffs one frame of at most `FRAME_MAX_BYTES` and appends the delimiter."""
    if len(frame) > FRAME_MAX_BYTES:
        raise StuffingError(f"{len(frame)} bytes: at most {FRAME_MAX_BYTES} fit one frame")
    stuffed = bytearray()
    for block in frame.split(DELIMITER):
        stuffed += _CODES[len(block) + 1]
        stuffed += block
    stuffed += DELIMITER
    return bytes(stuffed)


def decode(stuffed: bytes) -> bytes:
    """Undoes `encode` for one frame given without its delimiter.

    Raises:
        StuffingError: a code byte is zero, full, or points past the end.
    """
    blocks = []
    start, end = 0, len(stuffed)
    while start < end:
        code = stuffed[start]
        stop = start + code
        if code in (0, 255) or stop > end:
            raise StuffingError(f"code {code} at byte {start} of {end}")
        blocks.append(stuffed[start + 1 : stop])
        start = stop
    return DELIMITER.join(blocks)
