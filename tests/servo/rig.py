"""Servos to test with: as a process of their own, or their configuration for one in this process."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hapticd import _core
from hapticd.frame import Records
from hapticd.model import load_model
from hapticd.record import record_dtype

PATIENCE_S = 20.0
"""Far more than anything here takes; only a failure waits that long."""


PATIENT: Mapping[str, Any] = {"limits.late_ticks": 1_000_000, "limits.heartbeat_s": 1.0}
"""A busy machine makes a loop without real-time scheduling late: that is no fault here."""


def until(condition: Callable[[], bool], what: str) -> None:
    """Waits for a condition. ``AssertionError`` naming ``what`` when it never holds."""
    deadline_s = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline_s, f"waited in vain for {what}"
        time.sleep(0.002)


def servo_config(region: Path, **changes: Any) -> dict[str, Any]:
    """What a front writes for the servo of a PHANTOM twin that never gives up on its front."""
    model = load_model("phantom-1.0", PATIENT)
    return {
        "device_id": "phantom",
        "device_model": json.loads(model.device_json),
        "twin_model": json.loads(model.twin_json),
        "driver": "twin",
        "options": {},
        "rate_hz": 1000.0,
        "region": str(region),
        "realtime": "off",
        "priority": 80,
        "cpu": None,
        "seed": 1,
        "orphan_exit_s": None,
        **changes,
    }


class ServoRig:
    """Servo processes on one region, and the ends of that region."""

    def __init__(self, directory: Path) -> None:
        self.region = directory / "phantom.shm"
        self._config = directory / "servo.json"
        self._processes: list[subprocess.Popen[str]] = []

    def launch(self, **changes: Any) -> subprocess.Popen[str]:
        """Starts a servo process, ready or not."""
        self._config.write_text(json.dumps(servo_config(self.region, **changes)))
        command = [sys.executable, "-m", "hapticd.servo", str(self._config)]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self._processes.append(process)
        return process

    def start(self, **changes: Any) -> subprocess.Popen[str]:
        """Starts a servo process and waits for its first tick."""
        process = self.launch(**changes)
        until(lambda: self._ticks(process.pid), "the first tick")
        return process

    def _ticks(self, pid: int) -> bool:
        try:
            observer = _core.Front(str(self.region), observe=True)
        except (FileNotFoundError, _core.RegionError):
            return False
        return observer.info()["pid"] == pid and observer.head() > 0

    def front(self) -> _core.Front:
        return _core.Front(str(self.region))

    def observer(self) -> _core.Front:
        return _core.Front(str(self.region), observe=True)

    def close(self) -> None:
        """Kills what still runs."""
        for process in self._processes:
            if process.poll() is None:
                process.kill()
            process.communicate()


def ask(front: _core.Front, **request: Any) -> _core.Ack:
    """Sends one request, beating meanwhile, and returns its ack."""
    front.heartbeat()
    request_id = front.send(json.dumps(request))
    found: list[_core.Ack] = []

    def answered() -> bool:
        front.heartbeat()
        found.extend(ack for ack in front.acks() if ack["id"] == request_id)
        return bool(found)

    until(answered, f"the ack of {request}")
    return found[0]


def enable(front: _core.Front) -> None:
    """Enables the device: the first tick that hears the front may still refuse for want of one."""
    desired = {"type": "desired", "desired": "enabled"}
    until(lambda: ask(front, **desired)["result"] == "applied", "the device to be enabled")


def records(data: bytes) -> Records:
    """Tick records as a structured array."""
    return np.frombuffer(data, record_dtype())


def state(front: _core.Front) -> int:
    """Number of the device's state in the newest tick."""
    return int(records(front.latest())["state"][0])
