"""A driver written in Python, called from the loop of a servo in this process."""

from __future__ import annotations

import gc
import json
import struct
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from hapticd import _core
from hapticd.model import load_model
from tests.servo.rig import enable, records, servo_config, state, until

FRESH, MISSING, DOWN = 0, 1, 2
OFFLINE, DISABLED = 0, 1


class PlantDriver:
    """Drives a twin's plant through the face of a Python driver, and fails when told to."""

    def __init__(self) -> None:
        model = load_model("phantom-1.0")
        self._plant = _core.Plant(model.device_json, model.twin_json, 1000.0, 1)
        self.answer: int | Exception = FRESH
        self.threads: set[int] = set()
        self.last_command: Sequence[float] = ()
        self.connections = 0

    @property
    def identity(self) -> str:
        return f"plant, connection {self.connections}"

    def connect(self) -> None:
        self.connections += 1
        self.answer = FRESH

    def exchange(self, command: memoryview, observation: memoryview) -> int:
        self.threads.add(threading.get_ident())
        self.last_command = struct.unpack("=10d", command)
        if isinstance(self.answer, Exception):
            raise self.answer
        if self.answer == FRESH:
            observation[:] = self._plant.step(command)
        return self.answer

    def close(self) -> None:
        self.answer = DOWN


class Loop:
    """A servo in this process with its front, and what its main thread does."""

    def __init__(self, region: Path) -> None:
        document = servo_config(region, twin_model=None)
        del document["driver"], document["options"]
        self.driver = PlantDriver()
        self.servo = _core.Servo(json.dumps(document), self.driver)
        self.front = _core.Front(str(region))
        self.servo.start()

    def connect(self) -> None:
        """Takes the driver on and connects it."""
        assert self.servo.wait() == "down"
        self.driver.connect()
        self.servo.driver_ready()
        until(lambda: self.head_state() != OFFLINE, "the device to answer")

    def head_state(self) -> int:
        self.front.heartbeat()
        return state(self.front) if self.front.head() else OFFLINE

    def end(self) -> None:
        self.servo.request_stop()
        while self.servo.wait() == "down":
            pass


@pytest.fixture
def loop(tmp_path: Path) -> Iterator[Loop]:
    made = Loop(tmp_path / "phantom.shm")
    yield made
    made.end()


def test_the_device_is_offline_until_the_main_thread_has_connected_it(loop: Loop) -> None:
    until(lambda: loop.front.head() > 50, "some ticks")
    assert loop.head_state() == OFFLINE
    assert loop.driver.threads == set()
    loop.connect()
    assert loop.head_state() == DISABLED
    status = loop.front.status()
    assert status is not None
    assert status["identity"] == "plant, connection 1"
    assert not loop.front.info()["is_twin"]


def test_only_the_loop_s_own_thread_calls_the_driver(loop: Loop) -> None:
    loop.connect()
    until(lambda: loop.front.head() > 200, "some ticks")
    assert len(loop.driver.threads) == 1
    assert threading.get_ident() not in loop.driver.threads


def test_counts_and_commands_pass_unchanged(loop: Loop) -> None:
    loop.connect()
    enable(loop.front)
    until(lambda: loop.head_state() == 2 and loop.driver.last_command[0] == 1.0, "the outputs")
    assert len(loop.driver.last_command) == 10
    record = records(loop.front.latest())[0]
    home_rad = json.loads(load_model("phantom-1.0").device_json)["joints"]["home_rad"]
    assert record["joint_position_rad"].tolist() == pytest.approx(home_rad, abs=0.1)


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (DOWN, None),
        (OSError("the cable is out"), "OSError: the cable is out"),
        (7, "ValueError: exchange returned 7: 0 is fresh, 1 is missing, 2 is down"),
    ],
)
def test_a_driver_that_fails_is_left_alone_and_comes_back_disabled(
    loop: Loop, answer: int | Exception, why: str | None
) -> None:
    loop.connect()
    loop.driver.answer = answer
    assert loop.servo.wait() == "down"
    assert loop.servo.driver_error() == why
    until(lambda: loop.head_state() == OFFLINE, "the device to be offline")
    loop.driver.connect()
    loop.servo.driver_ready()
    until(lambda: loop.head_state() != OFFLINE, "the device to come back")
    assert loop.head_state() == DISABLED
    links = [e["details"]["link"] for e in loop.front.events() if e["kind"] == "device"]
    assert links == ["fresh", "down", "fresh"]


def test_a_driver_that_misses_frames_is_still_called(loop: Loop) -> None:
    loop.connect()
    loop.driver.answer = MISSING
    until(lambda: records(loop.front.latest())["observation_missing"][0] > 100, "missing frames")
    assert loop.head_state() != OFFLINE


def test_the_loop_leaves_no_garbage_for_the_collector(loop: Loop) -> None:
    loop.connect()
    gc.collect()
    before = loop.front.head()
    gc.disable()
    try:
        start = gc.get_count()[0]
        until(lambda: loop.front.head() > before + 500, "some ticks")
        grown = gc.get_count()[0] - start
    finally:
        gc.enable()
    assert grown < 100, f"{grown} tracked objects were left behind in 500 ticks"


def test_a_servo_starts_once(loop: Loop) -> None:
    with pytest.raises(RuntimeError, match="starts once"):
        loop.servo.start()
