"""The loop that serves an emulated device."""

from __future__ import annotations

import json
import os
from typing import Any

from hapticd_drivers.emulation import Emulation
from hapticd_drivers.error import OptionError
from hapticd_drivers.line import LineFaults
from hapticd_drivers.pseudo_terminal import PseudoTerminal
from hapticd_drivers.transport import SerialTransport


class Echo:
    """Sends back what it hears, and says tick now and then."""

    def __init__(self) -> None:
        self.told: list[dict[str, Any]] = []
        self.turns = 0

    def start(self, now_s: float) -> None:
        self._next_s = now_s

    def receive(self, data: bytes, now_s: float) -> bytes:
        return data

    def advance(self, now_s: float) -> bytes:
        self._next_s = now_s + 0.001
        self.turns += 1
        return b"tick\0" if self.turns % 5 == 0 else b""

    def next_s(self) -> float:
        return self._next_s

    def answers(self) -> bool:
        return True

    def control(self, message: dict[str, Any]) -> None:
        if "bad" in message:
            raise OptionError("bad is bad")
        self.told.append(message)


def serve(device: Echo, emulation: Emulation, turns: int, commands: bytes = b"") -> list[str]:
    """Runs for some turns with `commands` typed; returns what was refused."""
    refused: list[str] = []
    reader, writer = os.pipe()
    os.write(writer, commands)
    os.close(writer)
    last = device.turns + turns
    emulation.run(reader, lambda: device.turns >= last, refused.append)
    os.close(reader)
    return refused


def test_bytes_reach_the_device_and_come_back() -> None:
    device, terminal = Echo(), PseudoTerminal()
    with Emulation(device, terminal, LineFaults(), 1) as emulation:
        port = SerialTransport(terminal.port, 921_600)
        port.open()
        port.write(b"hello\0")
        serve(device, emulation, 20)
        assert port.read(5.0).startswith(b"hello\0tick\0tick\0")
        port.close()


def test_typed_lines_reach_the_device_and_bad_ones_are_refused_with_the_reason() -> None:
    device = Echo()
    with Emulation(device, PseudoTerminal(), LineFaults(), 1) as emulation:
        lines = [{"hand": {"type": "free"}}, {"bad": 1}, {"faults": "lose=3"}, {"faults": "lose=1"}, [1]]
        typed = "\n".join([*map(json.dumps, lines), "{no json", ""])
        refused = serve(device, emulation, 20, typed.encode())
    assert device.told == [{"hand": {"type": "free"}}]
    assert [why.split(":")[0] for why in refused] == [
        "bad is bad",
        "lose=3",
        'give an object, such as {"hand"',
        "Expecting property name enclosed in double quotes",
    ]


def test_the_cable_can_be_spoilt_while_it_runs() -> None:
    device, terminal = Echo(), PseudoTerminal()
    with Emulation(device, terminal, LineFaults(), 1) as emulation:
        port = SerialTransport(terminal.port, 921_600)
        port.open()
        serve(device, emulation, 10, b'{"faults": "lose=1"}\n')
        while port.read(0.0):
            pass
        port.write(b"hello\0")
        serve(device, emulation, 20)
        assert port.read(0.0) == b""
        port.close()


def test_a_mute_device_says_nothing() -> None:
    device, terminal = Echo(), PseudoTerminal()
    with Emulation(device, terminal, LineFaults.parse("mute=0"), 1) as emulation:
        port = SerialTransport(terminal.port, 921_600)
        port.open()
        port.write(b"hello\0")
        serve(device, emulation, 20)
        assert port.read(0.0) == b""
        port.close()


def test_an_unplugged_device_comes_back_on_another_port(tmp_path: Any) -> None:
    device, link = Echo(), tmp_path / "port"
    with Emulation(device, PseudoTerminal(link), LineFaults.parse("unplug=0+0.02"), 1) as emulation:
        before = link.stat().st_ino
        serve(device, emulation, 3)
        assert not os.path.exists(link) or link.stat().st_ino == before
        serve(device, emulation, 200)
        assert os.path.exists(link)
    assert not link.is_symlink()
