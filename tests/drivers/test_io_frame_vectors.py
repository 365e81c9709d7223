"""Every frame printed in docs/io-frame.vectors.json, both ways, and every way to damage it."""

from __future__ import annotations

import json
from binascii import crc_hqx
from pathlib import Path
from typing import Any

import pytest

from hapticd_drivers import cobs
from hapticd_drivers.hapticd_io import protocol
from hapticd_drivers.hapticd_io.frame import (
    CRC_INIT,
    ChecksumError,
    FrameError,
    Kind,
    decode_frame,
    encode_frame,
)

DOCS = Path(__file__).parents[2] / "docs"
VECTORS: list[dict[str, Any]] = json.loads((DOCS / "io-frame.vectors.json").read_text())
PAYLOADS = {
    "STATE": protocol.State,
    "STATE_MIN": protocol.StateMin,
    "COMMAND": protocol.Command,
    "DESCRIBE_RSP": protocol.Description,
    "CONFIG": protocol.Config,
    "CONFIG_ACK": protocol.Config,
}

each_vector = pytest.mark.parametrize("vector", VECTORS, ids=lambda vector: vector["name"])


def payload_of(vector: dict[str, Any]) -> bytes:
    fields = {
        key: tuple(value) if isinstance(value, list) else value for key, value in vector["fields"].items()
    }
    if "uid" in fields:
        fields["uid"] = bytes.fromhex(fields["uid"])
    return PAYLOADS[vector["kind"]](**fields).pack() if fields else b""


@each_vector
def test_fields_encode_to_the_printed_frame(vector: dict[str, Any]) -> None:
    raw = encode_frame(
        Kind[vector["kind"]], vector["seq"], vector["ack"], payload_of(vector), vector["flags"]
    )
    assert raw.hex(" ").upper() == vector["frame"]


@each_vector
def test_the_printed_frame_decodes_to_its_fields(vector: dict[str, Any]) -> None:
    frame = decode_frame(bytes.fromhex(vector["frame"]))
    assert (frame.kind, frame.seq, frame.ack, frame.flags) == (
        Kind[vector["kind"]],
        vector["seq"],
        vector["ack"],
        vector["flags"],
    )
    assert frame.payload == payload_of(vector)
    if payload := PAYLOADS.get(vector["kind"]):
        assert payload.unpack(frame.payload).pack() == frame.payload


@each_vector
def test_the_printed_frame_stuffs_to_the_printed_wire_bytes(vector: dict[str, Any]) -> None:
    raw = bytes.fromhex(vector["frame"])
    wire = bytes.fromhex(vector.get("wire", cobs.encode(raw).hex()))
    assert cobs.encode(raw) == wire
    assert cobs.decode(wire[:-1]) == raw


@each_vector
def test_any_one_or_two_flipped_bits_are_caught(vector: dict[str, Any]) -> None:
    """CRC-16/IBM-3740 finds every one- and two-bit error in frames this short."""
    raw = bytes.fromhex(vector["frame"])
    bits = range(len(raw) * 8)
    for first in bits:
        for second in (first, *bits[first + 1 :: 7]):
            damaged = bytearray(raw)
            damaged[first // 8] ^= 1 << first % 8
            if second != first:
                damaged[second // 8] ^= 1 << second % 8
            with pytest.raises(FrameError):
                decode_frame(bytes(damaged))


@each_vector
def test_any_cut_or_grown_frame_is_caught(vector: dict[str, Any]) -> None:
    raw = bytes.fromhex(vector["frame"])
    for damaged in (*(raw[:end] for end in range(len(raw))), raw + b"\0", b"\0" + raw):
        with pytest.raises(FrameError):
            decode_frame(damaged)


@each_vector
def test_the_document_prints_every_vector(vector: dict[str, Any]) -> None:
    printed = "".join((DOCS / "io-frame.md").read_text().split())
    assert vector["frame"].replace(" ", "") in printed


def test_the_checksum_is_the_catalogued_one() -> None:
    """CRC-16/IBM-3740 of "123456789" is 0x29B1 (CRC catalogue)."""
    assert crc_hqx(b"123456789", CRC_INIT) == 0x29B1


def test_a_wrong_checksum_is_told_from_a_malformed_frame() -> None:
    raw = bytearray(encode_frame(Kind.LOG, 0, 0, b"x"))
    raw[-1] ^= 0xFF
    with pytest.raises(ChecksumError):
        decode_frame(bytes(raw))


@pytest.mark.parametrize("version_kind", [0x01, 0x21, 0x10, 0x18, 0x1D])
def test_another_version_or_an_unknown_type_is_refused(version_kind: int) -> None:
    body = bytes([0xA5, version_kind, 10, 0, 0, 0, 0, 0])
    with pytest.raises(FrameError):
        decode_frame(body + crc_hqx(body, CRC_INIT).to_bytes(2, "little"))
