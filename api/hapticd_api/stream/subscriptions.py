"""The telemetry one client has asked for."""

from __future__ import annotations

import asyncio
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

from hapticd.problem import Problem
from hapticd.station import Station
from hapticd.telemetry import Subscription
from hapticd_api.stream.connection import Connection
from hapticd_api.stream.message import Subscribe

SUBSCRIPTIONS_MAX = 64
"""Subscriptions of one client."""


@dataclass(frozen=True, slots=True)
class _Entry:
    device_id: str
    subscription: Subscription
    resources: ExitStack
    task: asyncio.Task[None] | None = None


class Subscriptions:
    """Each subscription has a task that takes its frames and sends them.

    A slow client makes the task wait; the frames it cannot take meanwhile are dropped and counted behind it.
    """

    def __init__(self, station: Station, connection: Connection, tasks: asyncio.TaskGroup) -> None:
        self._station = station
        self._connection = connection
        self._tasks = tasks
        self._entries: dict[str, _Entry] = {}

    def watches(self, device_id: str | None) -> bool:
        """Whether any subscription is to this device."""
        return any(entry.device_id == device_id for entry in self._entries.values())

    def add(self, request: Subscribe) -> dict[str, Any]:
        """Prepares a subscription, and returns what was granted. Raises `Problem`.

        Frames are sent once `start` is called, so that the client hears of the grant first.
        """
        self._check_room(request.id)
        device = self._station.device(request.device)
        telemetry = self._station.telemetry[device.device_id]
        resources = ExitStack()
        subscription = resources.enter_context(
            telemetry.subscribe(request.signals, request.rate_hz, request.mode)
        )
        self._entries[request.id] = _Entry(device.device_id, subscription, resources)
        selection = subscription.selection
        return {
            "device": device.device_id,
            "signals": list(selection.signals),
            "rate_hz": selection.rate_hz,
            "mode": selection.mode,
        }

    def start(self, subscription_id: str) -> None:
        """Sends the frames of a subscription from now on."""
        entry = self._entries[subscription_id]
        task = self._tasks.create_task(self._pump(subscription_id, entry.subscription))
        task.add_done_callback(lambda _: entry.resources.close())
        self._entries[subscription_id] = _Entry(entry.device_id, entry.subscription, entry.resources, task)

    def remove(self, subscription_id: str) -> None:
        """Ends a subscription. Raises `Problem` when there is none of this id."""
        entry = self._entries.pop(subscription_id, None)
        if entry is None:
            detail = f"There is no subscription {subscription_id!r}."
            raise Problem("invalid-document", detail, pointer="/id", allowed=list(self._entries))
        entry.resources.close()
        if entry.task is not None:
            entry.task.cancel()

    def close(self) -> None:
        """Ends all of them."""
        for subscription_id in list(self._entries):
            self.remove(subscription_id)

    async def _pump(self, subscription_id: str, subscription: Subscription) -> None:
        while True:
            await self._connection.send_data(subscription_id, await subscription.next())

    def _check_room(self, subscription_id: str) -> None:
        if subscription_id in self._entries:
            detail = f"There is a subscription {subscription_id!r} already; unsubscribe it first."
            raise Problem("invalid-document", detail, pointer="/id")
        if len(self._entries) >= SUBSCRIPTIONS_MAX:
            raise Problem("invalid-document", f"One client has at most {SUBSCRIPTIONS_MAX} subscriptions.")
