"""The station: every device, its supervisor and its telemetry, started and stopped as one."""

from __future__ import annotations

import asyncio
import fcntl
import json
import os
import tempfile
import uuid
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO

from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.config import Config, DeviceConfig
from hapticd.device import Device
from hapticd.events import EventLog
from hapticd.heartbeat import Heartbeat
from hapticd.jobs import Jobs
from hapticd.model import Model, load_model
from hapticd.problem import Problem
from hapticd.scene_store import SceneStore
from hapticd.servo_process import ServoProcess
from hapticd.supervisor import Supervisor
from hapticd.telemetry import Telemetry

DISABLE_TIMEOUT_S = 1.5
SUPERVISORS_END_S = 1.0


class Station:
    """Everything the daemon runs. The API is built over this.

    Raises ``Problem`` (config-invalid, directory-unusable) when the configuration cannot be run.
    """

    def __init__(self, config: Config) -> None:
        self.config = config
        self.boot_id = uuid.uuid4().hex
        paths = config.paths
        for directory in (paths.state_dir, paths.runtime_dir):
            _make_usable(directory)
        self.events = EventLog(paths.state_dir)
        self._settling = SettlingLibrary(paths.state_dir / "stability")
        models = {device.id: _model(device) for device in config.devices}
        self.devices: Mapping[str, Device] = {
            device.id: self._device(device, models[device.id]) for device in config.devices
        }
        self.telemetry: Mapping[str, Telemetry] = {
            device_id: Telemetry(device) for device_id, device in self.devices.items()
        }
        self.jobs = Jobs(paths.state_dir, self.events, self.device)
        self._heartbeat = Heartbeat()
        self._supervisors = {
            device.id: self._supervisor(device, models[device.id]) for device in config.devices
        }
        self._tasks: list[asyncio.Task[None]] = []
        self._supervising: list[asyncio.Task[None]] = []
        self._lock: IO[str] | None = None
        self._stopping = False

    def device(self, device_id: str) -> Device:
        """The device of this id. ``Problem``: device-not-found; stopping."""
        if self._stopping:
            raise Problem("stopping", "The daemon is stopping.")
        if device_id not in self.devices:
            detail = f"There is no device {device_id!r}."
            raise Problem("device-not-found", detail, allowed=list(self.devices))
        return self.devices[device_id]

    async def start(self) -> None:
        """Begins to start or attach every servo. Devices are offline until theirs is there.

        Raises ``Problem`` (already-running) when another daemon has the runtime directory.
        """
        self._lock = _lock(self.config.paths.runtime_dir)
        self._heartbeat.start()
        self._settling.open()
        for device in self.devices.values():
            device.stability.prepare()
        self.events.append("daemon.started", "The daemon started.", details={"boot_id": self.boot_id})
        self._tasks = [asyncio.create_task(self._heartbeat.watch_loop(), name="heartbeat")]
        for device_id, telemetry in self.telemetry.items():
            self._tasks.append(asyncio.create_task(telemetry.run(), name=f"telemetry of {device_id}"))
        for device_id, supervisor in self._supervisors.items():
            self._supervising.append(asyncio.create_task(supervisor.run(), name=f"supervisor of {device_id}"))

    async def stop(self) -> None:
        """Fades every force out, then ends servos and tasks; takes a few seconds at most."""
        self._stopping = True
        await asyncio.gather(self.jobs.stop(), *(self._disable(device) for device in self.devices.values()))
        await asyncio.gather(*(supervisor.stop() for supervisor in self._supervisors.values()))
        if self._supervising:
            await asyncio.wait(self._supervising, timeout=SUPERVISORS_END_S)
        tasks = self._supervising + self._tasks
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._heartbeat.stop()
        await asyncio.to_thread(self._settling.close)
        self.events.append("daemon.stopped", "The daemon stopped.", details={"boot_id": self.boot_id})
        if self._lock is not None:
            self._lock.close()

    def ready(self) -> list[str]:
        """What keeps the daemon from being ready, as sentences; empty when it is."""
        checks = [_check(device) for device in self.devices.values()]
        failed = [task.get_name() for task in self._supervising + self._tasks if task.done()]
        stopping = ["The daemon is stopping."] if self._stopping else []
        return (
            [check for check in checks if check]
            + [f"The task {name} has ended." for name in failed]
            + stopping
        )

    def _device(self, config: DeviceConfig, model: Model) -> Device:
        store = SceneStore(self.config.paths.state_dir / "scenes", config.id, model.dof)
        return Device(config, model, store, self.events, self._settling)

    def _supervisor(self, config: DeviceConfig, model: Model) -> Supervisor:
        servo = ServoProcess(config, model, self.config.paths.runtime_dir)
        return Supervisor(self.devices[config.id], servo, self._heartbeat, self.events)

    async def _disable(self, device: Device) -> None:
        """Fades the device out before its servo is told to go, also where the servo is not ours to stop."""
        with suppress(Problem, TimeoutError):
            await asyncio.wait_for(device.set_desired("disabled"), DISABLE_TIMEOUT_S)


def _check(device: Device) -> str | None:
    snapshot = device.snapshot()
    if snapshot.state == "offline":
        return f"{device.device_id} is offline. {snapshot.health.why or ''}".rstrip()
    return None


def _model(config: DeviceConfig) -> Model:
    try:
        model = load_model(config.model, config.overrides)
        if config.on_loss is None:
            return model
        if json.loads(model.device_json).get("brakes") is None:
            raise ValueError(f"on_loss says what brakes do, and {model.name} has none")
        return load_model(config.model, config.model_overrides)
    except (OSError, ValueError) as error:
        raise Problem("config-invalid", f"Device {config.id!r}: {error}") from error


def _make_usable(directory: Path) -> None:
    try:
        directory.mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        raise Problem("directory-unusable", f"{directory} cannot be used: {error.strerror}.") from error
    # In a directory that everybody may write to, somebody else may have made this one.
    if os.getuid() not in (0, directory.stat().st_uid):
        raise Problem("directory-unusable", f"{directory} belongs to another user.")


def _lock(runtime_dir: Path) -> IO[str]:
    """Takes the runtime directory for this daemon.

    The kernel lets go of it when the daemon dies, however it dies.
    """
    lock = (runtime_dir / "front.lock").open("w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock.close()
        raise Problem("already-running", f"Another daemon uses {runtime_dir}.") from None
    return lock
