"""`hapticd emulate` as a process, with the driver of this package on the other end of its port."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from hapticd.config import DeviceConfig
from hapticd.model import load_model
from hapticd_drivers.commands import app
from hapticd_drivers.error import DeviceLost
from hapticd_drivers.hapticd_io import HapticdIo, create
from hapticd_drivers.hapticd_io.driver import DOWN, FRESH
from hapticd_drivers.hapticd_io.observation import ESTOP_INPUT, OBSERVATION, OUTPUTS_LIVE
from tests.drivers.device_rig import COMMAND

EXCHANGES_MAX = 20_000
SLOW_HZ = 250

pytestmark = pytest.mark.system


class Emulated:
    """The process and what it printed."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [
                sys.executable,
                "-m",
                "hapticd",
                "emulate",
                "hapticd_io",
                "--json",
                "--rate",
                str(SLOW_HZ),
                *arguments,
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        printed = self.process.stdout.readline()
        assert printed, self.end()
        self.report: dict[str, Any] = json.loads(printed)

    def type(self, message: dict[str, Any]) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(message) + "\n")
        self.process.stdin.flush()

    def end(self) -> str:
        """Ends it gently and returns what it complained about."""
        self.process.terminate()
        return self.process.communicate(timeout=20)[1]


@pytest.fixture
def emulated(tmp_path: Path) -> Iterator[Emulated]:
    emulated = Emulated("--twin", "hhd", "--link", str(tmp_path / "hhd.port"))
    yield emulated
    emulated.end()


@pytest.fixture
def driver(emulated: Emulated) -> Iterator[HapticdIo]:
    driver = create(emulated.report["options"], load_model("hhd"))
    driver.connect()
    yield driver
    driver.close()


def exchange_until(
    driver: HapticdIo, command: tuple[float, ...], done: Callable[[int, tuple[Any, ...]], bool]
) -> None:
    """Exchanges until `done(outcome, observation)`; the board paces the loop."""
    observation = bytearray(OBSERVATION.size)
    for _ in range(EXCHANGES_MAX):
        outcome = driver.exchange(memoryview(COMMAND.pack(*command)), memoryview(observation))
        if done(outcome, OBSERVATION.unpack(observation)):
            return
    raise AssertionError(f"not reached: {driver.statistics()}")


ENABLED = (1.0, *(0.0,) * 9)


@pytest.mark.parametrize("twin", ["hhd", "phantom-1.0"])
def test_the_printed_snippet_is_a_device_that_the_driver_connects_to(twin: str) -> None:
    emulated = Emulated("--twin", twin)
    try:
        device = DeviceConfig.model_validate(tomllib.loads(emulated.report["config"])["devices"][0])
        driver = create(device.options, load_model(device.model))
        driver.connect()
        assert emulated.report["options"]["uid"] in driver.identity
        driver.close()
    finally:
        assert emulated.end() == ""


def test_the_loop_closes_over_real_bytes(driver: HapticdIo) -> None:
    exchange_until(driver, ENABLED, lambda outcome, seen: seen[-1] & OUTPUTS_LIVE != 0)


def test_motors_move_the_twin(emulated: Emulated, driver: HapticdIo) -> None:
    """The hand lets go; 5 N·m on one joint overcome its friction."""
    emulated.type({"hand": {"type": "free"}})
    at_rest: list[int] = []
    exchange_until(driver, ENABLED, lambda outcome, seen: outcome == FRESH and not at_rest.append(seen[2]))
    turned = (1.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    exchange_until(driver, turned, lambda outcome, seen: abs(seen[2] - at_rest[0]) > 50)


def test_the_estop_button_can_be_pressed_from_the_keyboard(emulated: Emulated, driver: HapticdIo) -> None:
    emulated.type({"estop": True})
    exchange_until(driver, ENABLED, lambda outcome, seen: seen[-1] & ESTOP_INPUT != 0)
    emulated.type({"estop": False})
    exchange_until(driver, (0.0,) * 10, lambda outcome, seen: seen[-1] & ESTOP_INPUT == 0)


def test_a_killed_emulator_is_down_and_a_new_one_is_found_behind_the_same_link(
    emulated: Emulated, driver: HapticdIo
) -> None:
    exchange_until(driver, ENABLED, lambda outcome, seen: seen[-1] & OUTPUTS_LIVE != 0)
    emulated.process.kill()
    exchange_until(driver, ENABLED, lambda outcome, seen: outcome == DOWN)
    with pytest.raises(DeviceLost):
        driver.connect()
    again = Emulated("--twin", "hhd", "--link", emulated.report["port"])
    try:
        driver.connect()
        exchange_until(driver, (0.0,) * 10, lambda outcome, seen: outcome == FRESH)
    finally:
        driver.close()
        again.end()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no_such_driver"], "no driver no_such_driver"),
        (["hapticd_io", "--twin", "no-such-model"], "no model"),
        (["hapticd_io", "--faults", "loose=1"], "unknown fault loose"),
        (["hapticd_io", "--hand", '{"type": "wave"}'], "wave"),
        (["hapticd_io", "--hand", "{"], "Expecting property name"),
    ],
)
def test_a_wrong_argument_is_named(arguments: list[str], words: str) -> None:
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.replace("│", " ").split())
