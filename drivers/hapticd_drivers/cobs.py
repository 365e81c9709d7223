"""COBS byte stuffing: a frame without a single 0x00, so that 0x00 can end it (Cheshire & Baker, 1999)."""

from __future__ import annotations

from typing import Final

DELIMITER: Final = b"\0"
"""Ends every stuffed frame."""

FRAME_MAX_BYTES: Final = 253
"""Longest frame taken here: no block is ever full, so the 0xFF code never occurs."""

_CODES: Final = tuple(bytes([code]) for code in range(FRAME_MAX_BYTES + 2))


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
        StuffingError: a zero inside, too long, or a code that points past the end.
    """
    if 0 in stuffed or len(stuffed) > FRAME_MAX_BYTES + 1:
        raise StuffingError(f"{len(stuffed)} bytes with a zero, or too many")
    frame = bytearray(stuffed)
    code_at, end = 0, len(frame)
    while code_at < end:
        code = frame[code_at]
        frame[code_at] = 0
        code_at += code
    if code_at != end:
        raise StuffingError(f"a code points to byte {code_at} of {end}")
    return bytes(frame[1:])
