"""Byte stuffing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hapticd_drivers import cobs

zero_rich = st.lists(st.sampled_from([0, 0, 0, 1, 2, 255]), max_size=cobs.FRAME_MAX_BYTES).map(bytes)
frames = st.binary(max_size=cobs.FRAME_MAX_BYTES) | zero_rich


@given(frames)
def test_a_frame_comes_back_from_its_stuffing(frame: bytes) -> None:
    assert cobs.decode(cobs.encode(frame)[:-1]) == frame


@given(frames)
def test_zero_occurs_only_at_the_end_and_costs_one_byte(frame: bytes) -> None:
    stuffed = cobs.encode(frame)
    assert stuffed.index(0) == len(stuffed) - 1 == len(frame) + 1


@given(st.binary(max_size=80))
def test_whatever_decodes_was_encoded_like_this(noise: bytes) -> None:
    """There is one stuffing of a frame: noise is refused, or it is that one."""
    try:
        frame = cobs.decode(noise)
    except cobs.StuffingError:
        return
    assert noise == b"" or cobs.encode(frame)[:-1] == noise


def test_a_frame_too_long_for_one_block_is_refused() -> None:
    with pytest.raises(cobs.StuffingError):
        cobs.encode(bytes(cobs.FRAME_MAX_BYTES + 1))
