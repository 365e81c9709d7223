"""A link fed with whatever a wire can bring."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hapticd_drivers.hapticd_io.frame import FLAG_RESYNC, Kind
from hapticd_drivers.hapticd_io.link import STUFFED_MAX_BYTES, Link

texts = st.lists(st.binary(max_size=54), min_size=1, max_size=12)


def cut(data: bytes, sizes: list[int]) -> list[bytes]:
    """`data` in chunks of these sizes, and the rest."""
    chunks, start = [], 0
    for size in sizes:
        chunks.append(data[start : start + size])
        start += size
    return [*chunks, data[start:]]


@given(texts, st.lists(st.integers(0, 70)))
def test_frames_arrive_however_the_bytes_are_cut(payloads: list[bytes], sizes: list[int]) -> None:
    sender, receiver = Link(), Link()
    wire = b"".join(sender.send(Kind.LOG, payload) for payload in payloads)
    frames = [frame for chunk in cut(wire, sizes) for frame in receiver.receive(chunk)]
    assert [frame.payload for frame in frames] == payloads
    assert [frame.seq for frame in frames] == list(range(1, len(payloads) + 1))
    assert receiver.counters.checksum_errors == receiver.counters.malformed == 0


@given(texts, st.binary(max_size=300).map(lambda noise: noise.replace(b"\0", b"")), st.integers(0, 11))
def test_noise_between_frames_costs_at_most_the_frame_it_touches(
    payloads: list[bytes], noise: bytes, where: int
) -> None:
    sender, receiver = Link(), Link()
    wires = [sender.send(Kind.LOG, payload) for payload in payloads]
    where = min(where, len(wires) - 1)
    wires[where] = noise + wires[where]
    arrived = [frame.payload for wire in wires for frame in receiver.receive(wire)]
    assert arrived in (payloads, payloads[:where] + payloads[where + 1 :])


@given(st.lists(st.binary(max_size=200), max_size=8))
def test_noise_never_makes_a_frame_and_is_never_hoarded(chunks: list[bytes]) -> None:
    link = Link()
    for chunk in chunks:
        assert link.receive(chunk) == []
        assert len(link._partial) <= STUFFED_MAX_BYTES


def test_a_line_without_delimiters_counts_once_and_recovers_at_the_next() -> None:
    sender, receiver = Link(), Link()
    for _ in range(5):
        assert receiver.receive(b"\x55" * 100) == []
    assert receiver.receive(b"\0") == []
    assert receiver.counters.malformed == 1
    assert len(receiver.receive(sender.send(Kind.LOG, b"again"))) == 1


def test_each_end_acknowledges_what_it_heard_last() -> None:
    host, board = Link(), Link()
    assert board.receive(host.send(Kind.DESCRIBE_REQ))[0].ack == 0
    board.receive(host.send(Kind.DESCRIBE_REQ))
    assert host.receive(board.send(Kind.LOG, b""))[0].ack == 2


def test_the_first_frame_says_that_counting_starts_and_the_counter_wraps() -> None:
    sender, receiver = Link(), Link()
    flags = [receiver.receive(sender.send(Kind.LOG))[0].flags for _ in range(2)]
    assert flags == [FLAG_RESYNC, 0]
    sender._seq = 0xFFFF
    assert receiver.receive(sender.send(Kind.LOG))[0][1:3] == (0, 0)


def test_after_a_gap_in_the_bytes_the_next_whole_frame_is_read() -> None:
    sender, receiver = Link(), Link()
    first, second, third = (sender.send(Kind.LOG, text) for text in (b"one", b"two", b"three"))
    assert receiver.receive(first[:7]) == []
    receiver.skip_rest()
    assert [frame.payload for frame in receiver.receive(second[3:] + third)] == [b"three"]
    assert receiver.counters.malformed == receiver.counters.checksum_errors == 0


def test_a_whole_frame_right_after_a_gap_is_not_lost() -> None:
    sender, receiver = Link(), Link()
    receiver.skip_rest()
    assert len(receiver.receive(sender.send(Kind.LOG, b"one"))) == 1
