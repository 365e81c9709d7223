"""A board with a device on it: the emulated board and the twin's physics behind it."""

from __future__ import annotations

import json
from typing import Any, Final, Protocol

from hapticd_drivers.error import OptionError
from hapticd_drivers.hapticd_io.board import Board
from hapticd_drivers.hapticd_io.emulated_board import emulated_options
from hapticd_drivers.hapticd_io.frame import Kind
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.options import Options
from hapticd_drivers.hapticd_io.plant_wiring import PlantWiring
from hapticd_drivers.hapticd_io.protocol import Description
from hapticd_drivers.hapticd_io.wiring import Wiring

LATE_MAX_S: Final = 0.1
"""After a longer stop of this process the clock is taken up again instead of caught up with."""

HOST_PATIENCE: Final = 1.5
"""Host-paced: ticks without a COMMAND after which time goes on by itself."""


class Physics(Protocol):
    """The physics: `hapticd._core.Plant`."""

    def step(self, command: bytes) -> bytes:
        """One tick under ten doubles; returns an observation."""

    def hand(self, script_json: str) -> None:
        """Gives the operator's hand a task."""


class Emulator:
    """An `EmulatedDevice`. Its clock ticks at `rate_hz`, one step of the plant each.

    Board-paced it sends STATE on its own timer. Host-paced every COMMAND is one tick of the host,
    whenever it comes, so that a run does not depend on how exactly the host keeps time.
    """

    def __init__(self, plant: Physics, board: Board, wiring: Wiring) -> None:
        self.board = board
        self._plant = plant
        self._wires = PlantWiring(wiring)
        self._tick_s = 1.0 / board.description.tick_max_hz
        self._ticks = 0
        self._next_s = 0.0
        self._host_ticks = 0
        self._estop = False

    def start(self, now_s: float) -> None:
        """See `EmulatedDevice.start`: the first latch."""
        self._step()
        self._next_s = now_s + self._tick_s

    def next_s(self) -> float:
        """See `EmulatedDevice.next_s`."""
        return self._next_s

    def answers(self) -> bool:
        """See `EmulatedDevice.answers`."""
        return self.board.host_paced

    def receive(self, data: bytes, now_s: float) -> bytes:
        """See `EmulatedDevice.receive`. A host-paced STATE leaves before the physics of the next tick."""
        replies = []
        for frame in self.board.link.receive(data) if data else ():
            if self.board.host_paced and frame.kind is Kind.COMMAND:
                replies.append(self.board.state())
                self._host_ticks += 1
            replies.append(self.board.handle(frame))
        return b"".join(replies)

    def advance(self, now_s: float) -> bytes:
        """See `EmulatedDevice.advance`."""
        if self._host_ticks:
            self._pass_host_ticks(now_s)
        if now_s - self._next_s > LATE_MAX_S:
            self._next_s = now_s
        sent = []
        while self._next_s <= now_s:
            self._step()
            self._next_s += self._tick_s
            if not self.board.host_paced and self._ticks % self._decimation() == 0:
                sent.append(self.board.state())
        return b"".join(sent)

    def control(self, message: dict[str, Any]) -> None:
        """Takes `hand` (a script) and `estop` (true: the input is open)."""
        for key, value in message.items():
            if key == "hand":
                self._plant.hand(json.dumps(value))
            elif key == "estop" and isinstance(value, bool):
                self._estop = value
            else:
                raise OptionError(f"{key}: give hand, estop (true or false) or faults")

    def _decimation(self) -> int:
        return self.board.description.tick_max_hz // self.board.tick_hz

    def _pass_host_ticks(self, now_s: float) -> None:
        for _ in range(self._host_ticks * self._decimation()):
            self._step()
        self._host_ticks = 0
        self._next_s = now_s + HOST_PATIENCE * self._decimation() * self._tick_s

    def _step(self) -> None:
        self._ticks += 1
        board = self.board
        observation = self._plant.step(self._wires.to_command(board.sequence.live, board.outputs.values))
        t_us = round(self._ticks * self._tick_s * 1e6)
        self.board.tick(t_us, self._wires.to_latch(observation, self._estop))


def emulator(plant: Physics, needs: Needs, board: Description) -> Emulator:
    """The emulator of a board, wired as `emulated_options` says."""
    wiring = Wiring(Options.parse(emulated_options(needs, board, "-"), needs), needs, board)
    return Emulator(plant, Board(board), wiring)
