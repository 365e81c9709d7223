"""The servo process: how it ends is known, and end it does."""

import asyncio
import json
import sys
from pathlib import Path

import pytest

from hapticd import servo_process
from hapticd.config import DeviceConfig
from hapticd.model import load_model
from hapticd.servo_process import ServoProcess

CONFIG = DeviceConfig(id="phantom", model="phantom-1.0", seed=5)


def process(runtime_dir: Path, script: str, config: DeviceConfig = CONFIG) -> ServoProcess:
    """A servo that runs ``script`` in place of the loop; its configuration file is ``sys.argv[1]``."""
    return ServoProcess(config, load_model(config.model), runtime_dir, (sys.executable, "-c", script))


async def ended(servo: ServoProcess) -> str:
    async with asyncio.timeout(20.0):
        while (ending := servo.ending()) is None:  # noqa: ASYNC110 - another process sets it
            await asyncio.sleep(0.01)
    return ending


async def test_configuration_is_handed_over_in_a_file(tmp_path: Path) -> None:
    servo = process(tmp_path, "import sys; print(open(sys.argv[1]).read())")
    await servo.launch()
    await ended(servo)
    handed = json.loads((tmp_path / "phantom.log").read_text())
    assert (handed["device_id"], handed["seed"], handed["region"]) == ("phantom", 5, str(servo.region))
    assert handed["device_model"]["name"] == "phantom-1.0"
    assert handed["twin_model"] is not None


async def test_hardware_gets_no_twin(tmp_path: Path) -> None:
    config = CONFIG.model_copy(update={"driver": "hapticd_io", "options": {"port": "/dev/x"}})
    servo = process(tmp_path, "import sys; print(open(sys.argv[1]).read())", config)
    await servo.launch()
    await ended(servo)
    handed = json.loads((tmp_path / "phantom.log").read_text())
    assert (handed["twin_model"], handed["driver"], handed["options"]) == (
        None,
        "hapticd_io",
        {"port": "/dev/x"},
    )


async def test_failure_is_told_with_the_last_words(tmp_path: Path) -> None:
    servo = process(tmp_path, "print('one'); raise SystemExit('no driver named sponge')")
    await servo.launch()
    assert await ended(servo) == "Its servo exited with code 1. Its log ends: no driver named sponge"
    assert servo.pid is None


async def test_kill_is_told_with_its_signal(tmp_path: Path) -> None:
    servo = process(tmp_path, "import os; os.kill(os.getpid(), 9)")
    await servo.launch()
    assert await ended(servo) == "Its servo was killed by signal 9."


async def test_servo_that_exits_on_request_is_not_killed(tmp_path: Path) -> None:
    servo = process(tmp_path, "import time; time.sleep(60)")
    await servo.launch()
    assert servo.pid is not None
    assert servo.ending() is None
    assert await servo.terminate() is True
    assert servo.pid is None


async def test_servo_that_does_not_exit_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(servo_process, "TERMINATE_S", 0.2)
    deaf = "; ".join(
        [
            "import signal, sys, time",
            "signal.signal(signal.SIGTERM, signal.SIG_IGN)",
            "open(sys.argv[1] + '.deaf', 'w').close()",
            "time.sleep(60)",
        ]
    )
    servo = process(tmp_path, deaf)
    await servo.launch()
    async with asyncio.timeout(20.0):
        while not (tmp_path / "phantom.json.deaf").exists():  # noqa: ASYNC110 - another process makes it
            await asyncio.sleep(0.01)
    assert await servo.terminate() is False
    assert servo.pid is None


async def test_servo_of_an_earlier_front_is_known_by_its_configuration(tmp_path: Path) -> None:
    assert process(tmp_path, "pass").configured_alike()
    earlier = process(tmp_path, "pass")
    await earlier.launch()
    await ended(earlier)
    assert process(tmp_path, "pass").configured_alike()
    assert not process(tmp_path, "pass", CONFIG.model_copy(update={"seed": 6})).configured_alike()


async def test_ending_a_servo_that_never_started_is_no_work(tmp_path: Path) -> None:
    assert await process(tmp_path, "pass").terminate() is True
