"""A client that does not read costs only itself."""

from __future__ import annotations

import asyncio
import itertools
from typing import Any

import pytest
from starlette.websockets import WebSocket

from hapticd.problem import Problem
from hapticd.telemetry import QUEUE_MAX
from hapticd_api.stream import connection as connection_module
from hapticd_api.stream import subscriptions as subscriptions_module
from hapticd_api.stream.close import CloseCode
from hapticd_api.stream.codec import DEFAULT
from hapticd_api.stream.connection import Closing, Connection
from hapticd_api.stream.message import Subscribe
from hapticd_api.stream.subscriptions import Subscriptions
from tests.api.conftest import Rig


class StuckSocket(WebSocket):
    """A socket whose sends wait until `open` is set."""

    def __init__(self) -> None:
        self.open = asyncio.Event()
        self.sent: list[Any] = []

    async def send(self, message: Any) -> None:
        await self.open.wait()
        self.sent.append(message)


def subscribe(signals: tuple[str, ...]) -> Subscribe:
    """A subscription to every tick of the phantom."""
    return Subscribe(type="subscribe", id="all", device="phantom", signals=signals, mode="batch")


async def test_frames_a_client_cannot_take_are_dropped_and_counted(rig: Rig) -> None:
    socket = StuckSocket()
    connection = Connection(socket, DEFAULT)
    telemetry = rig.station.telemetry["phantom"]
    async with asyncio.TaskGroup() as tasks:
        subscriptions = Subscriptions(rig.station, connection, tasks)
        subscriptions.add(subscribe(("tick",)))
        subscriptions.start("all")
        for _ in range(4 * QUEUE_MAX):
            await asyncio.sleep(0.002)
            telemetry.pump()
        socket.open.set()
        await asyncio.sleep(0.05)
        subscriptions.remove("all")
    frames = [DEFAULT.decode(message["text"]) for message in socket.sent]
    assert frames[1]["dropped"] > 0
    for before, after in itertools.pairwise(frames):
        assert after["tick"] == before["tick"] + before["count"] + after["dropped"]


async def test_client_that_takes_nothing_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection_module, "SEND_TIMEOUT_S", 0.02)
    with pytest.raises(Closing) as closing:
        await Connection(StuckSocket(), DEFAULT).send({"type": "pong"})
    assert closing.value.code == CloseCode.TOO_SLOW


async def test_subscriptions_of_one_client_are_bounded(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subscriptions_module, "SUBSCRIPTIONS_MAX", 0)
    async with asyncio.TaskGroup() as tasks:
        held = Subscriptions(rig.station, Connection(StuckSocket(), DEFAULT), tasks)
        with pytest.raises(Problem, match="at most 0"):
            held.add(subscribe(("tick",)))
