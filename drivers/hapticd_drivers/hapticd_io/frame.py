"""The hapticd I/O frame, version 1: header, length and CRC (docs/io-frame.md §1, §2)."""

from __future__ import annotations

from binascii import crc_hqx
from enum import IntEnum
from struct import Struct
from typing import Final, NamedTuple

SYNC: Final = 0xA5
VERSION: Final = 1
CRC_INIT: Final = 0xFFFF  # crc_hqx with this start value is CRC-16/IBM-3740
OVERHEAD_BYTES: Final = 10  # header and CRC
FRAME_MAX_BYTES: Final = 64

FLAG_RESYNC: Final = 1 << 0
"""The sender's counter starts anew with this frame."""

_HEADER: Final = Struct("<BBBBHH")
_CRC: Final = Struct("<H")


class Kind(IntEnum):
    """Frame types."""

    STATE = 0x1
    STATE_MIN = 0x2
    COMMAND = 0x3
    DESCRIBE_REQ = 0x4
    DESCRIBE_RSP = 0x5
    CONFIG = 0x6
    CONFIG_ACK = 0x7
    NAK = 0xE
    LOG = 0xF


PAYLOAD_BYTES: Final = {
    Kind.STATE: 54,
    Kind.STATE_MIN: 22,
    Kind.COMMAND: 30,
    Kind.DESCRIBE_REQ: 0,
    Kind.DESCRIBE_RSP: 54,
    Kind.CONFIG: 12,
    Kind.CONFIG_ACK: 12,
    Kind.NAK: 4,
}
"""Payload of each type of fixed length; LOG is text of any length that fits."""

_KINDS: Final = {int(kind): kind for kind in Kind}


class FrameError(ValueError):
    """Bytes that are not a frame of this version: dropped and counted, never acted upon."""


class ChecksumError(FrameError):
    """A frame whose CRC does not fit."""


class Frame(NamedTuple):
    """One frame off the wire."""

    kind: Kind
    flags: int
    seq: int
    ack: int
    payload: bytes


def encode_frame(kind: Kind, seq: int, ack: int, payload: bytes, flags: int = 0) -> bytes:
    """A frame with header and CRC, not yet stuffed."""
    length = len(payload) + OVERHEAD_BYTES
    body = _HEADER.pack(SYNC, VERSION << 4 | kind, length, flags, seq, ack) + payload
    return body + _CRC.pack(crc_hqx(body, CRC_INIT))


def decode_frame(raw: bytes) -> Frame:
    """Checks and splits one unstuffed frame.

    Raises:
        ChecksumError: the CRC does not fit.
        FrameError: wrong sync, length, version or type.
    """
    size = len(raw)
    if size < OVERHEAD_BYTES or raw[0] != SYNC or raw[2] != size:
        raise FrameError(f"no frame in {size} bytes")
    if crc_hqx(raw[:-2], CRC_INIT) != raw[-2] | raw[-1] << 8:
        raise ChecksumError(f"CRC of {size} bytes")
    _, version_kind, _, flags, seq, ack = _HEADER.unpack_from(raw)
    kind = _KINDS.get(version_kind & 0xF)
    if version_kind >> 4 != VERSION or kind is None:
        raise FrameError(f"version and type {version_kind:#04x}")
    if PAYLOAD_BYTES.get(kind, size - OVERHEAD_BYTES) != size - OVERHEAD_BYTES:
        raise FrameError(f"{kind.name} of {size} bytes")
    return Frame(kind, flags, seq, ack, raw[8:-2])
