"""Requests to one servo, each matched with its acknowledgement."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

from hapticd.problem import Problem

if TYPE_CHECKING:
    from hapticd._core import Ack, ServoEvent, ServoInfo, ServoStatus

ACK_TIMEOUT_S = 1.0
POLL_S = 0.001


class Link(Protocol):
    """The front's end of a servo's shared memory: ``hapticd._core.Front``, which documents each method."""

    def info(self) -> ServoInfo: ...
    def heartbeat(self) -> None: ...
    def send(self, request_json: str, /) -> int: ...
    def acks(self) -> list[Ack]: ...
    def events(self) -> list[ServoEvent]: ...
    def head(self) -> int: ...
    def read(self, since: int, max_ticks: int, /) -> tuple[bytes, int, int]: ...
    def latest(self) -> bytes: ...
    def status(self) -> ServoStatus | None: ...
    def servo_alive(self) -> bool: ...
    def close(self) -> None: ...


class Channel:
    """The way to one servo and back. Lives as long as its link; belongs to the event loop's thread."""

    def __init__(self, device_id: str, link: Link) -> None:
        self._device_id = device_id
        self._link = link
        self._waiting: dict[int, asyncio.Future[Ack]] = {}
        self._collector: asyncio.Task[None] | None = None

    async def request(self, request: Mapping[str, Any]) -> Ack:
        """Sends one request and waits for its acknowledgement, whatever it says.

        Raises ``Problem``: servo-busy, servo-silent after ``ACK_TIMEOUT_S``, device-offline when the servo
        goes.
        """
        future: asyncio.Future[Ack] = asyncio.get_running_loop().create_future()
        request_id = self._send(request)
        self._waiting[request_id] = future
        self._collect()
        try:
            return await asyncio.wait_for(future, ACK_TIMEOUT_S)
        except TimeoutError:
            detail = f"{self._device_id} did not acknowledge {request['type']!r} within {ACK_TIMEOUT_S:g} s."
            raise Problem("servo-silent", detail, device_id=self._device_id) from None
        finally:
            self._waiting.pop(request_id, None)

    def close(self, why: str) -> None:
        """Ends every waiting request with a problem: the servo is gone."""
        if self._collector is not None:
            self._collector.cancel()
        for future in self._waiting.values():
            if not future.done():
                future.set_exception(Problem("device-offline", why, device_id=self._device_id))

    def _send(self, request: Mapping[str, Any]) -> int:
        try:
            return self._link.send(json.dumps(request, allow_nan=False))
        except BlockingIOError:
            detail = f"The request queue of {self._device_id} is full."
            raise Problem("servo-busy", detail, device_id=self._device_id) from None

    def _collect(self) -> None:
        if self._collector is None or self._collector.done():
            self._collector = asyncio.create_task(self._collect_acks(), name=f"acks-{self._device_id}")

    async def _collect_acks(self) -> None:
        while self._waiting:
            for ack in self._link.acks():
                future = self._waiting.get(ack["id"])
                if future is not None and not future.done():
                    future.set_result(ack)
            await asyncio.sleep(POLL_S)
