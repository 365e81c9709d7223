"""Serial ports, on pseudo-terminals."""

from __future__ import annotations

import struct
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from hapticd_drivers import transport as transport_module
from hapticd_drivers.error import DeviceLost
from hapticd_drivers.pseudo_terminal import PseudoTerminal
from hapticd_drivers.transport import SerialTransport

LONG_S = 5.0


@pytest.fixture
def terminal() -> Iterator[PseudoTerminal]:
    terminal = PseudoTerminal()
    yield terminal
    terminal.close()


@pytest.fixture
def port(terminal: PseudoTerminal) -> Iterator[SerialTransport]:
    port = SerialTransport(terminal.port, 921_600)
    port.open()
    yield port
    port.close()


def heard(terminal: PseudoTerminal, size: int) -> bytes:
    """What the board hears; the kernel hands it over a little after it was written."""
    data = b""
    for _ in range(5000):
        data += terminal.read()
        if len(data) >= size:
            break
        time.sleep(0.001)
    return data


def test_every_byte_value_goes_through_both_ways(terminal: PseudoTerminal, port: SerialTransport) -> None:
    every = bytes(range(256))
    assert port.write(every) == 256
    assert heard(terminal, 256) == every
    terminal.write(every)
    assert port.read(LONG_S) == every


def test_nothing_to_read_is_empty_on_both_ends(terminal: PseudoTerminal, port: SerialTransport) -> None:
    assert port.read(0.0) == b""
    assert port.read(0.001) == b""
    assert terminal.read() == b""


def test_what_arrived_before_opening_is_not_read(terminal: PseudoTerminal) -> None:
    terminal.write(b"old")
    time.sleep(0.05)
    port = SerialTransport(terminal.port, 921_600)
    port.open()
    terminal.write(b"new")
    assert port.read(LONG_S) == b"new"
    port.close()


def test_flushing_drops_what_has_arrived_however_much_it_is(
    terminal: PseudoTerminal, port: SerialTransport
) -> None:
    for _ in range(10):
        terminal.write(bytes(1000))
    time.sleep(0.05)
    port.flush()
    terminal.write(b"new")
    assert port.read(LONG_S) == b"new"


def test_a_hung_up_port_is_lost_for_reading_and_writing(
    terminal: PseudoTerminal, port: SerialTransport
) -> None:
    terminal.close()
    with pytest.raises(DeviceLost):
        port.read(LONG_S)
    with pytest.raises(DeviceLost):
        port.write(b"x")
    with pytest.raises(DeviceLost):
        port.flush()


def test_a_board_that_does_not_read_stops_neither_writing_nor_closing(port: SerialTransport) -> None:
    taken = [port.write(bytes(4096)) for _ in range(64)]
    assert taken[-1] == 0
    port.close()


def test_a_port_that_is_not_there_says_so() -> None:
    with pytest.raises(DeviceLost, match=r"/dev/nowhere: no such port: is it plugged in"):
        SerialTransport("/dev/nowhere", 9600).open()


def test_a_port_is_opened_by_one_program_only(terminal: PseudoTerminal, port: SerialTransport) -> None:
    with pytest.raises(DeviceLost, match="taken by another program"):
        SerialTransport(terminal.port, 921_600).open()


def test_closing_never_waits_for_the_board_to_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel drains for closing_wait, 30 s, unless it is told 65535 (none)."""
    written: list[bytes] = []

    def ioctl(_fd: int, request: int, settings: bytes | bytearray) -> int:
        if request == 0x541F:
            written.append(bytes(settings))
        return 0

    monkeypatch.setattr(transport_module.fcntl, "ioctl", ioctl)
    transport_module._never_wait_on_close(0)
    assert struct.unpack_from("<H", written[0], 40) == (65535,)
    assert len(written[0]) == 72


def test_a_link_names_the_present_port_until_it_is_removed(tmp_path: Path) -> None:
    link = tmp_path / "hhd.port"
    terminal = PseudoTerminal(link)
    assert str(link.readlink()) == terminal.port
    terminal.close()
    other = PseudoTerminal()
    terminal.open()
    assert str(link.readlink()) == terminal.port != other.port
    terminal.remove_link()
    assert not link.is_symlink()
    terminal.close()
    other.close()


def test_a_link_taken_over_by_another_is_left_alone(tmp_path: Path) -> None:
    link = tmp_path / "hhd.port"
    first, second = PseudoTerminal(link), PseudoTerminal(link)
    first.remove_link()
    assert str(link.readlink()) == second.port
    first.close()
    second.close()
