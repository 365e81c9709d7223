"""A daemon in a process of its own, as a user starts it."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Self

import httpx

START_S = 30.0
POLL_S = 0.02

PHANTOM = {"id": "phantom", "model": "phantom-1.0"}
HHD = {"id": "hhd", "model": "hhd"}

FLOOR = {
    "id": "floor",
    "shape": {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]},
    "law": {"type": "motion", "eta": 0.0},
}
"""A rigid floor below the PHANTOM's home."""

UNDER_FLOOR = {"type": "push", "direction": [0, 0, -1], "force_n": 3.0, "speed_m_per_s": 0.1}


def wait_until(condition: Callable[[], Any], what: str, timeout_s: float = START_S) -> Any:
    """What ``condition`` returns once it is true. AssertionError after ``timeout_s``."""
    end_s = time.monotonic() + timeout_s
    while time.monotonic() < end_s:
        if value := condition():
            return value
        time.sleep(POLL_S)
    raise AssertionError(f"waited {timeout_s:g} s in vain for {what}")


def free_port() -> int:
    """A port nobody listens on now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def toml(table: Mapping[str, Any]) -> str:
    """A table of the configuration as inline TOML values, one key a line."""
    return "\n".join(f"{key} = {toml_value(value)}" for key, value in table.items())


def toml_value(value: object) -> str:
    """A configuration value as TOML: numbers, strings, tables and lists of them."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f'"{key}" = {toml_value(item)}' for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else str(value).lower()


class DaemonProcess:
    """The daemon on a free port, with its state and shared memory under ``directory``."""

    def __init__(self, directory: Path, devices: list[dict[str, Any]]) -> None:
        self.directory = directory
        self.runtime_dir = directory / "run"
        self.port = free_port()
        self.config = directory / "hapticd.toml"
        self.config.write_text(self._config(devices), encoding="utf-8")
        self.http = httpx.Client(base_url=f"http://127.0.0.1:{self.port}", timeout=5.0)
        self.process: subprocess.Popen[bytes] | None = None

    def start(self) -> Self:
        """Starts the daemon and waits until every device is there."""
        with (self.directory / "daemon.log").open("ab") as log:
            command = [sys.executable, "-m", "hapticd", "run", "--config", str(self.config)]
            self.process = subprocess.Popen(command, stdout=log, stderr=log)
        wait_until(self.ready, f"the daemon to be ready; see {self.directory}/daemon.log")
        return self

    def ready(self) -> bool:
        """Whether every device is there."""
        assert self.process is not None
        assert self.process.poll() is None, (self.directory / "daemon.log").read_text(encoding="utf-8")
        with suppress(httpx.TransportError):
            return self.http.get("/readyz").status_code == 200
        return False

    def kill_front(self) -> None:
        """kill -9 of the front alone."""
        assert self.process is not None
        self.process.kill()
        self.process.wait()

    def stop(self) -> None:
        """Ends the daemon and every servo of it."""
        self.http.close()
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(15)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    def device(self, device_id: str) -> dict[str, Any]:
        """The device as the API tells it."""
        answer = self.http.get(f"/api/v1/devices/{device_id}")
        answer.raise_for_status()
        return dict(answer.json())

    def put(self, path: str, document: object, **headers: str) -> dict[str, Any]:
        """PUT below ``/api/v1/devices``; AssertionError unless it succeeds."""
        answer = self.http.put(f"/api/v1/devices/{path}", json=document, headers=headers)
        assert answer.is_success, answer.text
        return dict(answer.json())

    def press(self, device_id: str, wall: dict[str, Any], hand: dict[str, Any]) -> None:
        """Puts up a wall, enables the device and pushes the hand into it until there is a force."""
        self.put(f"{device_id}/scene/walls/{wall['id']}", wall)
        self.put(f"{device_id}/state", {"desired": "enabled"})
        self.put(f"{device_id}/twin/hand", hand)
        wait_until(lambda: self.pushes(device_id), f"{device_id} to push back")

    def pushes(self, device_id: str) -> bool:
        """Whether the device is in contact and gives more than 1 N."""
        device = self.device(device_id)
        squared_n2 = sum(force_n**2 for force_n in device["tip_force_n"])
        return bool(device["flags"]["contact"] and squared_n2 > 1.0)

    def servo_pid(self, device_id: str) -> int:
        """Process of the device's servo."""
        return int(self.device(device_id)["health"]["pid"])

    def kill_servo(self, device_id: str) -> None:
        """kill -9 of one servo."""
        os.kill(self.servo_pid(device_id), signal.SIGKILL)

    def region(self, device_id: str) -> Path:
        """Shared memory of the device's servo."""
        return next(self.runtime_dir.glob(f"{device_id}*.shm"))

    def _config(self, devices: list[dict[str, Any]]) -> str:
        paths = {"state_dir": str(self.directory / "state"), "runtime_dir": str(self.runtime_dir)}
        sections = [f"[api]\nport = {self.port}", f"[paths]\n{toml(paths)}"]
        sections += [f"[[devices]]\n{toml(device)}" for device in devices]
        return "\n\n".join(sections)
