"""One client's WebSocket: messages in and out, with a bound on both."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

from starlette.types import Message
from starlette.websockets import WebSocket, WebSocketDisconnect

from hapticd.problem import Problem
from hapticd.telemetry import Delivery
from hapticd_api.stream.close import REASONS, CloseCode
from hapticd_api.stream.codec import Codec

MESSAGE_MAX_BYTES = 64 * 1024
"""Largest message a client may send."""

SEND_TIMEOUT_S = 10.0
"""A client that takes nothing for this long is closed."""


class Closing(Exception):
    """The stream ends. `code` is None when the client has ended it already."""

    def __init__(self, code: CloseCode | None) -> None:
        super().__init__("client gone" if code is None else REASONS[code])
        self.code = code


class Connection:
    """Sends and receives messages in the client's encoding. Every method raises `Closing` once it is over."""

    def __init__(self, websocket: WebSocket, codec: Codec) -> None:
        self._websocket = websocket
        self._codec = codec
        self._sending = asyncio.Lock()

    async def send(self, message: Mapping[str, Any]) -> None:
        """Sends one message; waits while the client is slow."""
        await self._send(self._codec.encode(message))

    async def send_data(self, subscription_id: str, delivery: Delivery) -> None:
        """Sends one telemetry frame."""
        await self._send(self._codec.data(subscription_id, delivery))

    async def send_problem(self, problem: Problem, **about: Any) -> None:
        """Sends an `error` message. `about` says which request it answers."""
        await self.send({"type": "error", **about, "problem": problem.document()})

    async def receive(self) -> Any:
        """What the next message holds. Raises `Undecodable`."""
        message = await self._websocket.receive()
        if message["type"] == "websocket.disconnect":
            raise Closing(None)
        text = message.get("text")
        payload: str | bytes = message["bytes"] if text is None else text
        if len(payload) > MESSAGE_MAX_BYTES:
            raise Closing(CloseCode.TOO_BIG)
        return self._codec.decode(payload)

    async def close(self, code: CloseCode) -> None:
        """Closes with a documented code and its reason. The client may have gone meanwhile."""
        try:
            async with asyncio.timeout(SEND_TIMEOUT_S):
                await self._websocket.close(code, REASONS[code])
        except (WebSocketDisconnect, RuntimeError, TimeoutError):
            return

    async def _send(self, message: Message) -> None:
        try:
            async with self._sending, asyncio.timeout(SEND_TIMEOUT_S):
                await self._websocket.send(message)
        except TimeoutError:
            raise Closing(CloseCode.TOO_SLOW) from None
        except (WebSocketDisconnect, RuntimeError):
            # Starlette raises RuntimeError for a send after the close it has seen.
            raise Closing(None) from None


def first_closing(group: BaseExceptionGroup[Closing]) -> Closing:
    """The reason that ended a session whose tasks may have met several."""
    first = group.exceptions[0]
    return first_closing(first) if isinstance(first, BaseExceptionGroup) else first
