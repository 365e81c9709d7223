"""A driver, a cable and an emulated board in one process and in virtual time."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from struct import Struct
from typing import Any

from hapticd_drivers.error import DeviceLost
from hapticd_drivers.hapticd_io.driver import HapticdIo
from hapticd_drivers.hapticd_io.emulated_board import emulated_board, emulated_options
from hapticd_drivers.hapticd_io.emulator import Emulator, emulator
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.observation import CURRENT_PRESENT, FORCE_PRESENT, HOMED
from hapticd_drivers.hapticd_io.options import Options
from hapticd_drivers.line import Line, LineFaults

COMMAND = Struct("<10d")
OBSERVATION = Struct("<QQ3q3dd3dQ")
DEVICES = Path(__file__).parents[2] / "hapticd" / "devices"


def device_json(model: str) -> str:
    """The device part of a model file, as the control core gets it."""
    table = tomllib.loads((DEVICES / f"{model}.toml").read_text())
    table.pop("twin", None)
    return json.dumps(table)


class RecordingPlant:
    """A device that stands still: it keeps what it is commanded and shows what it is told to."""

    def __init__(self) -> None:
        self.commands: list[tuple[float, ...]] = []
        self.counts = (0, 0, 0)
        self.force_n = (0.0, 0.0, 0.0)
        self.current_a = (0.0, 0.0, 0.0)
        self.status = FORCE_PRESENT | CURRENT_PRESENT | HOMED
        self.script: dict[str, Any] = {}

    def step(self, command: bytes) -> bytes:
        self.commands.append(COMMAND.unpack(command))
        return OBSERVATION.pack(0, 0, *self.counts, *self.force_n, 0.0, *self.current_a, self.status)

    def hand(self, script_json: str) -> None:
        self.script = json.loads(script_json)

    @property
    def command(self) -> tuple[float, ...]:
        return self.commands[-1]


class VirtualCable:
    """A `ByteTransport` to an emulator. Time passes only while somebody waits."""

    def __init__(self, device: Emulator, faults: LineFaults | None = None, seed: int = 7) -> None:
        self.device = device
        self.now_s = 0.0
        self.plugged = True
        self.mute = False
        self.taken = 1 << 30
        self.spoil(faults or LineFaults(), seed)
        self._open = False
        device.start(0.0)

    def spoil(self, faults: LineFaults, seed: int) -> None:
        self._to_board, self._to_host = Line(faults, seed), Line(faults, seed + 1)

    def clock(self) -> float:
        return self.now_s

    def open(self) -> None:
        if not self.plugged:
            raise DeviceLost("no such port")
        self._open = True
        self._to_host.pull(self.now_s)

    def close(self) -> None:
        self._open = False

    def flush(self) -> None:
        self._require()
        self._to_host.pull(self.now_s)

    def write(self, data: bytes) -> int:
        self._require()
        accepted = data[: self.taken]
        self._to_board.push(accepted, self.now_s)
        self._run(self.now_s)
        return len(accepted)

    def read(self, timeout_s: float) -> bytes:
        self._require()
        deadline = self.now_s + timeout_s
        while not (data := self._to_host.pull(self.now_s)):
            wakes = (self.device.next_s(), self._to_board.next_s(), self._to_host.next_s())
            if min(wakes) > deadline:
                self._run(deadline)
                return self._to_host.pull(self.now_s)
            self._run(min(wakes))
        return data

    def pass_time(self, until_s: float) -> None:
        """The host does something else."""
        while (wake := min(self.device.next_s(), self._to_board.next_s())) <= until_s:
            self._run(wake)
        self._run(until_s)

    def _run(self, now_s: float) -> None:
        self.now_s = max(self.now_s, now_s)
        sent = self.device.receive(self._to_board.pull(self.now_s), self.now_s) + self.device.advance(
            self.now_s
        )
        if not self.mute:
            self._to_host.push(sent, self.now_s)

    def _require(self) -> None:
        if not self.plugged or not self._open:
            raise DeviceLost("gone")


class Rig:
    """A loop at `rate_hz` over a `HapticdIo` and a `RecordingPlant`."""

    def __init__(
        self, model: str = "hhd", pacing: str = "device", rate_hz: int = 1000, **options: Any
    ) -> None:
        self.needs = Needs.of(device_json(model))
        self.plant = RecordingPlant()
        self.description = emulated_board(self.needs, rate_hz, model, 1)
        self.cable = VirtualCable(emulator(self.plant, self.needs, self.description))
        raw = emulated_options(self.needs, self.description, "-") | {"pacing": pacing} | options
        self.options = Options.parse(raw, self.needs)
        self.driver = HapticdIo(self.options, self.needs, self.cable, self.cable.clock)
        self.observation = bytearray(OBSERVATION.size)
        self._tick_s = 1.0 / rate_hz
        self._next_s = 0.0

    def connect(self) -> Rig:
        self.driver.connect()
        self._next_s = self.cable.now_s
        return self

    def tick(self, command: tuple[float, ...] = (0.0,) * 10, ticks: int = 1) -> int:
        """Some ticks of the servo with one command; the outcome of the last."""
        outcome = -1
        for _ in range(ticks):
            self._next_s = max(self._next_s + self._tick_s, self.cable.now_s)
            self.cable.pass_time(self._next_s)
            outcome = self.driver.exchange(memoryview(COMMAND.pack(*command)), memoryview(self.observation))
        return outcome

    @property
    def axes(self) -> int:
        return self.needs.axes

    @property
    def has_force(self) -> bool:
        return bool(self.options.force.channels)

    def unplug(self) -> None:
        self.cable.plugged = False

    def replug(self) -> None:
        self.cable.plugged = True

    def silence(self) -> None:
        self.cable.mute = True

    def speak(self) -> None:
        self.cable.mute = False

    def press_estop(self) -> None:
        self.cable.device.control({"estop": True})

    def release_estop(self) -> None:
        self.cable.device.control({"estop": False})

    def host_dies(self, ticks: int) -> None:
        """Nobody calls the driver for some ticks."""
        self.cable.pass_time(self.cable.now_s + ticks * self._tick_s)

    def seen(self) -> dict[str, Any]:
        """The last observation."""
        seq, t_ns, *rest = OBSERVATION.unpack(self.observation)
        return {
            "seq": seq,
            "t_ns": t_ns,
            "counts": tuple(rest[0:3]),
            "force_n": tuple(rest[3:6]),
            "current_a": tuple(rest[7:10]),
            "status": rest[10],
        }
