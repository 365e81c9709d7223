"""One client on the stream: hello, requests, events."""

from __future__ import annotations

import asyncio
from typing import Any

from pydantic import ValidationError

from hapticd.events import EventFeed
from hapticd.problem import Problem
from hapticd.station import Station
from hapticd_api.errors import refused_document
from hapticd_api.stream.clock import clock_map
from hapticd_api.stream.close import CloseCode
from hapticd_api.stream.codec import Undecodable
from hapticd_api.stream.connection import Closing, Connection, first_closing
from hapticd_api.stream.message import (
    CLIENT_MESSAGE,
    PROTOCOL_VERSION,
    ClientMessage,
    Hello,
    Ping,
    Subscribe,
    Unsubscribe,
)
from hapticd_api.stream.shutdown import STOPPED
from hapticd_api.stream.subscriptions import Subscriptions
from hapticd_api.stream.welcome import welcome

HELLO_TIMEOUT_S = 10.0


class Session:
    """The conversation with one client, from hello to close."""

    def __init__(self, station: Station, connection: Connection) -> None:
        self._station = station
        self._connection = connection

    async def run(self) -> None:
        """Talks with the client until one side ends it, and closes."""
        code: CloseCode | None = None
        try:
            await self._greet()
            await self._converse()
        except* Closing as ended:
            code = first_closing(ended).code
        if code is not None:
            await self._connection.close(code)

    async def _greet(self) -> None:
        try:
            async with asyncio.timeout(HELLO_TIMEOUT_S):
                hello = await self._hello()
        except TimeoutError:
            raise Closing(CloseCode.NO_HELLO) from None
        if hello.version != PROTOCOL_VERSION:
            raise Closing(CloseCode.VERSION)
        await self._connection.send(welcome(self._station))

    async def _hello(self) -> Hello:
        while True:
            message = await self._next_message()
            if isinstance(message, Hello):
                return message
            if message is not None:
                detail = f"The first message must be hello, this was {message.type}."
                await self._connection.send_problem(Problem("invalid-document", detail, pointer="/type"))

    async def _converse(self) -> None:
        with self._station.events.subscribe() as feed:
            async with asyncio.TaskGroup() as tasks:
                subscriptions = Subscriptions(self._station, self._connection, tasks)
                tasks.create_task(self._relay(feed, subscriptions))
                tasks.create_task(self._listen(subscriptions))

    async def _listen(self, subscriptions: Subscriptions) -> None:
        while True:
            message = await self._next_message()
            if message is None:
                continue
            about = {"request": message.type, "id": getattr(message, "id", None)}
            try:
                await self._answer(message, about, subscriptions)
            except Problem as problem:
                await self._connection.send_problem(problem, **about)

    async def _answer(
        self, message: ClientMessage, about: dict[str, Any], subscriptions: Subscriptions
    ) -> None:
        match message:
            case Subscribe():
                granted = subscriptions.add(message)
                await self._connection.send({"type": "result", **about, **granted})
                await self._send_snapshot(message.device)
                subscriptions.start(message.id)
            case Unsubscribe():
                subscriptions.remove(message.id)
                await self._connection.send({"type": "result", **about})
            case Ping():
                await self._connection.send({"type": "pong", "nonce": message.nonce, "clock": clock_map()})
            case Hello():
                raise Problem("invalid-document", "There was a hello already.", pointer="/type")

    async def _relay(self, feed: EventFeed, subscriptions: Subscriptions) -> None:
        """Sends every event, and after it the device it changed as that device is now."""
        while (event := await feed.next()) is not None:
            await self._connection.send({"type": "event", "event": event.model_dump(mode="json")})
            if event.kind == STOPPED:
                raise Closing(CloseCode.SHUTDOWN)
            if event.device_id is not None and subscriptions.watches(event.device_id):
                await self._send_snapshot(event.device_id)
        raise Closing(CloseCode.TOO_SLOW)

    async def _send_snapshot(self, device_id: str) -> None:
        # Not by `device`, which refuses while the daemon stops: the last snapshots still go out.
        snapshot = self._station.devices[device_id].snapshot()
        document = snapshot.model_dump(mode="json")
        await self._connection.send({"type": "snapshot", "device": device_id, "snapshot": document})

    async def _next_message(self) -> ClientMessage | None:
        """The next message; None for one that cannot be understood, once the client has been told."""
        try:
            document = await self._connection.receive()
        except Undecodable as error:
            await self._connection.send_problem(Problem("malformed-json", str(error)))
            return None
        try:
            return CLIENT_MESSAGE.validate_python(document)
        except ValidationError as error:
            await self._connection.send_problem(refused_document(error.errors(), document))
            return None
