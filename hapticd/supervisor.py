"""The supervisor: keeps one device's servo running, and the device attached to it."""

from __future__ import annotations

import asyncio
import contextlib
import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

import structlog

from hapticd import _core
from hapticd.backoff import Backoff
from hapticd.channel import Link
from hapticd.device import Device
from hapticd.events import EventLog
from hapticd.heartbeat import Heartbeat
from hapticd.problem import Problem

WATCH_S = 0.05
READY_TIMEOUT_S = 10.0
RESTORE_AGAIN_S = 1.0
EXPLAIN_S = 1.0

STEADY_S = 30.0
"""A servo that ran this long was well: the next one is started without delay."""

STOPPING = "The daemon is stopping."
INTERRUPTED = "Its supervisor was interrupted."

log = structlog.get_logger(__name__)

OpenLink = Callable[[Path], Link]


class Servo(Protocol):
    """The servo process: ``hapticd.servo_process.ServoProcess``, which documents each method."""

    @property
    def region(self) -> Path: ...
    @property
    def pid(self) -> int | None: ...
    def configured_alike(self) -> bool: ...
    async def launch(self) -> None: ...
    def ending(self) -> str | None: ...
    def last_words(self) -> str: ...
    async def terminate(self) -> bool: ...


class ServoFailed(Exception):
    """The servo could not be started or reached; the text says why."""


def open_front(region: Path) -> Link:
    """The shared memory of a servo. ``OSError`` or ``RegionError`` when there is none of use."""
    return _core.Front(str(region))


def is_running(pid: int) -> bool:
    """Whether there is a process of this number, also one of another user."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


class Supervisor:
    """One device's supervisor. ``run`` is its task; ``stop`` ends the servo and lets the task end."""

    def __init__(
        self,
        device: Device,
        servo: Servo,
        heartbeat: Heartbeat,
        events: EventLog,
        *,
        open_link: OpenLink = open_front,
        is_running: Callable[[int], bool] = is_running,
        backoff: Backoff | None = None,
    ) -> None:
        self._device = device
        self._servo = servo
        self._heartbeat = heartbeat
        self._events = events
        self._open_link = open_link
        self._is_running = is_running
        self._backoff = backoff or Backoff()
        self._stopping = asyncio.Event()
        self._last_failure: str | None = None

    async def run(self) -> None:
        """Attaches to a living servo or starts one, again and again until ``stop``."""
        while not self._stopping.is_set():
            began_s = time.monotonic()
            await self._once()
            if time.monotonic() - began_s > STEADY_S:
                self._backoff.reset()
            await self._pause(self._backoff.pause_s())

    async def stop(self) -> None:
        """Ends the servo that this supervisor started; one that others started runs on, without a front.

        ``run`` returns soon after.
        """
        self._stopping.set()
        if not await self._servo.terminate():
            self._tell("servo.killed", "did not exit in time and was killed.")

    async def _once(self) -> None:
        try:
            link = await self._attach_to_living() or await self._launch()
            await self._serve(link)
        except (ServoFailed, OSError) as error:
            self._tell_failure(str(error))
            self._device.detach(str(error))
        except Exception:
            # A fault in here must not leave the device without a supervisor: the next round starts afresh.
            log.exception("supervisor", device_id=self._device.device_id)
            self._tell("servo.failed", "lost its servo by a fault of the daemon; its log has the trace.")

    async def _attach_to_living(self) -> Link | None:
        link = self._open_living()
        if link is None:
            return None
        if self._servo.configured_alike():
            return link
        self._tell("servo.outdated", "has a servo with another configuration; it is stopped.")
        await self._stop_other(link)
        return None

    def _open_living(self) -> Link | None:
        try:
            link = self._open_link(self._servo.region)
        except (OSError, _core.RegionError):
            return None
        info = link.info()
        # A servo that was just killed left a heartbeat that is still young.
        ticks = link.servo_alive() and self._is_running(info["pid"])
        if ticks and info["device_id"] == self._device.device_id:
            return link
        link.close()
        return None

    async def _stop_other(self, link: Link) -> None:
        try:
            link.send('{"type": "stop"}')
            await _silence(link)
        finally:
            link.close()

    async def _launch(self) -> Link:
        await self._servo.launch()
        deadline_s = time.monotonic() + READY_TIMEOUT_S
        why = "Its servo did not make its shared memory in time."
        while time.monotonic() < deadline_s and not self._stopping.is_set():
            if ending := self._servo.ending():
                raise ServoFailed(ending)
            try:
                link = self._open_link(self._servo.region)
            except (OSError, _core.RegionError) as error:
                why = f"Its servo's shared memory cannot be used: {error}."
            else:
                if link.info()["pid"] == self._servo.pid and link.servo_alive():
                    return link
                link.close()
            await asyncio.sleep(WATCH_S)
        await self._servo.terminate()
        raise ServoFailed(why)

    async def _serve(self, link: Link) -> None:
        """Stays attached until the servo goes."""
        why = INTERRUPTED
        self._last_failure = None
        self._heartbeat.add(link)
        self._device.attach(link)
        self._tell("servo.attached", "is attached to its servo.", {"pid": link.info()["pid"]})
        beside = [asyncio.create_task(work) for work in (self._restore(), self._explain_absence())]
        try:
            why = await self._until_gone(link)
        finally:
            for task in beside:
                task.cancel()
            self._device.detach(why)
            self._heartbeat.remove(link)
            link.close()

    async def _until_gone(self, link: Link) -> str:
        """Passes on what the servo tells until it goes; says why it went."""
        while (why := self._gone(link)) is None:
            self._device.tell_servo_events()
            await asyncio.sleep(WATCH_S)
        self._device.tell_servo_events()
        if self._stopping.is_set():
            return STOPPING
        self._tell("servo.lost", f"lost its servo. {why}")
        return why

    async def _restore(self) -> None:
        """Puts hand and scene in force, and again whenever the loop does not render the present scene."""
        while True:
            try:
                await self._device.restore()
            except Problem as problem:
                self._tell("scene.not_restored", f"does not render its scene yet. {problem.detail}")
            await asyncio.sleep(RESTORE_AGAIN_S)

    async def _explain_absence(self) -> None:
        """Says why the device is not there while its servo is: the servo's log has what the driver met."""
        while True:
            absent = self._device.snapshot().state == "offline"
            why = f"Its servo runs, but the device does not answer. {self._servo.last_words()}".rstrip()
            self._device.explain_absence(why if absent else None)
            await asyncio.sleep(EXPLAIN_S)

    def _gone(self, link: Link) -> str | None:
        if ending := self._servo.ending():
            return ending
        if self._stopping.is_set() and self._servo.pid is None:
            # Somebody else started this servo and stops it.
            return STOPPING
        return None if link.servo_alive() else "Its servo stopped beating."

    def _tell_failure(self, why: str) -> None:
        """Tells why there is no servo, once for each reason: attempts go on for ever."""
        if why != self._last_failure:
            self._last_failure = why
            self._tell("servo.failed", f"has no servo. {why}")

    def _tell(self, kind: str, message: str, details: Mapping[str, Any] | None = None) -> None:
        device_id = self._device.device_id
        self._events.append(kind, f"{device_id} {message}", device_id=device_id, details=details)

    async def _pause(self, pause_s: float) -> None:
        """Sleeps, but not into the end."""
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self._stopping.wait(), pause_s)


async def _silence(link: Link) -> None:
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(READY_TIMEOUT_S):
            while link.servo_alive():  # noqa: ASYNC110 - another process sets it
                await asyncio.sleep(WATCH_S)
