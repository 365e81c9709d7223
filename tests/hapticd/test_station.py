"""The station over real servos and their twins: what survives the death of whom."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import numpy as np
import pytest

from hapticd import _core
from hapticd.config import Config, DeviceConfig, PathsConfig
from hapticd.hand import HAND_SCRIPT
from hapticd.injection import INJECTION
from hapticd.problem import Problem
from hapticd.reading import STATES, records_of
from hapticd.station import Station
from hapticd.supervisor import is_running
from tests.hapticd.conftest import make_wall

pytestmark = pytest.mark.system

FORCE_N = 3.0
PUSH = HAND_SCRIPT.validate_python({"type": "push", "direction": [0, 0, -1], "force_n": FORCE_N})


def configured(directory: Path) -> Config:
    return Config(paths=PathsConfig(state_dir=directory / "state", runtime_dir=directory / "run"))


@pytest.fixture
async def station(tmp_path: Path) -> AsyncIterator[Station]:
    made = Station(configured(tmp_path))
    await made.start()
    try:
        await until(lambda: not made.ready())
        yield made
    finally:
        await made.stop()


async def until(condition: Callable[[], bool], timeout_s: float = 20.0) -> None:
    """Waits for something to become true in other processes."""
    async with asyncio.timeout(timeout_s):
        while not condition():  # noqa: ASYNC110 - other processes make it true
            await asyncio.sleep(0.01)


async def push_against_a_wall(station: Station) -> None:
    """The PHANTOM's hand pushes on a rigid floor."""
    phantom = station.device("phantom")
    await phantom.put_wall(
        make_wall("floor", shape={"type": "plane", "point_m": [0, 0, 0], "normal": [0, 0, 1]})
    )
    await phantom.set_desired("enabled")
    await phantom.set_hand(PUSH)
    await until(lambda: phantom.snapshot().contact_wall == "floor")


def pid_of(station: Station, device_id: str) -> int:
    pid = station.device(device_id).snapshot().health.pid
    assert pid is not None
    return pid


async def test_hand_that_pushes_on_a_wall_meets_its_force(station: Station) -> None:
    await push_against_a_wall(station)
    phantom = station.device("phantom")

    def settled() -> bool:
        newest = phantom.read(max(0, phantom.head() - 200), 200).records
        force_n = newest["tip_force_n"][:, 2]
        return len(newest) == 200 and bool(np.all(np.abs(force_n - FORCE_N) < 0.05 * FORCE_N))

    await until(settled)
    snapshot = phantom.snapshot()
    assert snapshot.tip_position_m is not None
    assert snapshot.stiffness_n_per_m is not None
    # Penetration is F/k_c (WN eq. 29); the device's friction carries a part of the push.
    assert -snapshot.tip_position_m[2] == pytest.approx(FORCE_N / snapshot.stiffness_n_per_m, rel=0.1)
    assert station.device("hhd").snapshot().state == "disabled"


async def test_killed_servo_costs_its_own_device_alone_and_comes_back_disabled(station: Station) -> None:
    await push_against_a_wall(station)
    phantom, hhd = station.device("phantom"), station.device("hhd")
    killed, untouched = pid_of(station, "phantom"), pid_of(station, "hhd")
    os.kill(killed, signal.SIGKILL)
    await until(lambda: phantom.snapshot().state == "offline")
    assert "killed by signal 9" in (phantom.snapshot().health.why or "")
    with pytest.raises(Problem, match="offline"):
        await phantom.set_desired("enabled")
    assert (await phantom.put_wall(make_wall("roof", eta=0.5))).applied is None
    await until(lambda: phantom.snapshot().state != "offline")
    assert phantom.snapshot().state == "disabled"
    await until(lambda: phantom.scene_in_force)
    assert [wall.id for wall in phantom.scene.walls] == ["floor", "roof"]
    assert pid_of(station, "phantom") != killed
    assert pid_of(station, "hhd") == untouched
    assert hhd.snapshot().state == "disabled"
    assert not [
        event for event in station.events.after() if event.kind == "servo.lost" and event.device_id == "hhd"
    ]


async def test_estop_survives_the_death_of_the_servo(station: Station) -> None:
    phantom = station.device("phantom")
    await phantom.engage_estop()
    os.kill(pid_of(station, "phantom"), signal.SIGKILL)
    await until(lambda: phantom.snapshot().state == "offline")
    await until(lambda: phantom.scene_in_force)
    assert phantom.snapshot().flags.estop
    with pytest.raises(Problem, match="E-stop"):
        await phantom.set_desired("enabled")


async def test_injected_fault_stops_the_device_until_it_is_acknowledged(station: Station) -> None:
    await push_against_a_wall(station)
    phantom = station.device("phantom")
    await phantom.inject(INJECTION.validate_python({"type": "encoder_jump", "duration_s": 0.05}))
    await until(lambda: phantom.snapshot().state == "fault")
    assert "encoder-jump" in [fault.id for fault in phantom.snapshot().faults]
    with pytest.raises(Problem) as caught:
        await phantom.set_desired("enabled")
    assert "fault-latched" in [entry["id"] for entry in caught.value.interlocks or ()]
    for fault in phantom.snapshot().faults:
        await phantom.acknowledge_fault(fault.id)
    await until(lambda: phantom.snapshot().state == "disabled")


async def test_stopping_fades_forces_and_leaves_no_servo_behind(tmp_path: Path) -> None:
    station = Station(configured(tmp_path))
    await station.start()
    await until(lambda: not station.ready())
    pids = [pid_of(station, device_id) for device_id in station.devices]
    await push_against_a_wall(station)
    region = tmp_path / "run" / "phantom.shm"
    watching = _core.Front(str(region), observe=True)
    await station.stop()
    since = watching.head() - 2000
    ticks = records_of(watching.read(max(0, since), 2000)[0])
    watching.close()
    assert not [pid for pid in pids if is_running(pid)]
    assert STATES[int(ticks["state"][-1])] == "disabled"
    assert np.all(ticks["motor_v"][-1] == 0.0)
    assert np.all(ticks["tip_force_command_n"][-1] == 0.0)
    limits = station.devices["phantom"].snapshot().limits
    steps_n = np.linalg.norm(np.diff(ticks["tip_force_n"], axis=0), axis=1)
    assert np.linalg.norm(ticks["tip_force_n"], axis=1).max() > 1.0
    assert steps_n.max() <= 1.01 * limits.tip_slew_n_per_s / station.devices["phantom"].rate_hz


async def test_second_daemon_on_the_same_servos_is_refused(station: Station) -> None:
    second = Station(station.config)
    with pytest.raises(Problem) as caught:
        await second.start()
    assert caught.value.slug == "already-running"
    assert station.ready() == []


FRONT = """
import asyncio, sys
from pathlib import Path
from hapticd.station import Station
from tests.hapticd.test_station import configured, push_against_a_wall, until

async def main():
    station = Station(configured(Path(sys.argv[1])))
    await station.start()
    await until(lambda: not station.ready())
    await push_against_a_wall(station)
    print("in contact", flush=True)
    await asyncio.sleep(60)

asyncio.run(main())
"""


async def test_killed_front_in_contact_fades_the_device_and_its_successor_takes_over(tmp_path: Path) -> None:
    front = await asyncio.create_subprocess_exec(
        sys.executable, "-c", FRONT, str(tmp_path), stdout=asyncio.subprocess.PIPE
    )
    assert front.stdout is not None
    assert await front.stdout.readline() == b"in contact\n"
    front.kill()
    await front.wait()
    watching = _core.Front(str(tmp_path / "run" / "phantom.shm"), observe=True)
    servo = watching.info()["pid"]
    await until(lambda: records_of(watching.latest())["state"][0] == STATES.index("fault"))
    watching.close()
    successor = Station(configured(tmp_path))
    await successor.start()
    try:
        await until(lambda: not successor.ready())
        phantom = successor.device("phantom")
        assert pid_of(successor, "phantom") == servo
        assert [fault.id for fault in phantom.snapshot().faults] == ["front-lost"]
        await until(lambda: phantom.snapshot().tip_force_n == pytest.approx([0.0, 0.0, 0.0], abs=1e-3))
        await until(lambda: phantom.scene_in_force)
        await phantom.acknowledge_fault("front-lost")
        await phantom.set_desired("enabled")
    finally:
        await successor.stop()


def test_unknown_model_is_a_problem_of_the_configuration(tmp_path: Path) -> None:
    devices = (DeviceConfig(id="a", model="sponge"),)
    with pytest.raises(Problem, match="no model 'sponge'") as caught:
        Station(configured(tmp_path).model_copy(update={"devices": devices}))
    assert caught.value.slug == "config-invalid"


def test_unknown_override_names_the_keys_there_are(tmp_path: Path) -> None:
    devices = (DeviceConfig(id="a", model="hhd", overrides={"limits.tip_force": 1.0}),)
    with pytest.raises(Problem, match=r"limits\.tip_force_n"):
        Station(configured(tmp_path).model_copy(update={"devices": devices}))


def test_brake_policy_of_a_device_without_brakes_is_refused(tmp_path: Path) -> None:
    devices = (DeviceConfig(id="a", model="phantom-1.0", on_loss="hold"),)
    with pytest.raises(Problem, match=r"on_loss says what brakes do, and phantom-1\.0 has none"):
        Station(configured(tmp_path).model_copy(update={"devices": devices}))


def test_brake_policy_reaches_the_model(tmp_path: Path) -> None:
    devices = (DeviceConfig(id="a", model="hhd", on_loss="hold"),)
    station = Station(configured(tmp_path).model_copy(update={"devices": devices}))
    assert json.loads(station.devices["a"].model.device_json)["brakes"]["release_on_stop"] is False


def test_directory_of_somebody_else_is_not_trusted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hapticd.station.os.getuid", lambda: 54321)
    with pytest.raises(Problem, match="belongs to another user"):
        Station(configured(tmp_path))


def test_directory_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "state").write_text("a file in the way")
    with pytest.raises(Problem, match="state cannot be used") as caught:
        Station(configured(tmp_path))
    assert caught.value.slug == "directory-unusable"
