"""The stream of a daemon: telemetry, snapshots and events over one WebSocket.

with Stream() as stream:
    stream.subscribe("phantom", ["tip_position_m", "tip_force_n"], rate_hz=60)
    for message in stream:
        ...
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any, Literal

from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from hapticd_client.connection import daemon_url
from hapticd_client.documents import Device, Event
from hapticd_client.error import NotHapticd, Refused, StreamClosed, Unreachable

PATH = "/api/v1/stream"
SUBPROTOCOL = Subprotocol("hapticd.v1+json")
VERSION = 1

Mode = Literal["latest", "batch"]


@dataclass(frozen=True, slots=True)
class Data:
    """Ticks of one device, ``tick`` and ``t_mono_ns`` being the first's.

    ``values`` holds one entry per signal: its newest value in mode ``latest``, a list over ``count`` ticks in
    mode ``batch``. ``dropped`` ticks before these were lost to this client.
    """

    device_id: str
    tick: int
    t_mono_ns: int
    count: int
    dropped: int
    values: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A device as it is after a subscription or an event."""

    device: Device


@dataclass(frozen=True, slots=True)
class Happening:
    """An event of the daemon."""

    event: Event


Message = Data | Snapshot | Happening


@contextmanager
def open_stream(url: str | None = None, *, timeout_s: float = 5.0) -> Iterator[Stream]:
    """The stream of the daemon at ``url``, by default ``$HAPTICD_URL`` or the default address.

    ``timeout_s`` bounds the opening and every answer, not the wait for messages. Raises `Unreachable` or
    `NotHapticd`.
    """
    address = daemon_url(url)
    with ExitStack() as resources:
        socket = _opened(resources, address, timeout_s)
        yield Stream(address, socket, timeout_s)


class Stream:
    """Messages of a daemon in the order they were sent; made by `open_stream`.

    Raises `StreamClosed` once the daemon has ended it.
    """

    def __init__(self, url: str, socket: ClientConnection, timeout_s: float) -> None:
        self._url = url
        self._timeout_s = timeout_s
        self._waiting: deque[Message] = deque()
        self._socket = socket
        self._send({"type": "hello", "version": VERSION, "client": "hapticd_client"})
        self.welcome = self._receive(timeout_s)

    @property
    def device_ids(self) -> list[str]:
        """The devices there are to subscribe to."""
        return [device["id"] for device in self.welcome["devices"]]

    def subscribe(
        self, device_id: str, signals: Sequence[str], *, rate_hz: float = 60.0, mode: Mode = "latest"
    ) -> None:
        """Asks for signals of a device, once each. `Refused` when a name is unknown."""
        wish = {
            "id": device_id,
            "device": device_id,
            "signals": list(signals),
            "rate_hz": rate_hz,
            "mode": mode,
        }
        self._send({"type": "subscribe", **wish})
        while True:
            raw = self._receive(self._timeout_s)
            if raw["type"] == "result":
                return
            self._keep(raw)

    def __iter__(self) -> Iterator[Message]:
        while True:
            yield self._next()

    def _next(self) -> Message:
        while not self._waiting:
            self._keep(self._receive(None))
        return self._waiting.popleft()

    def _keep(self, raw: dict[str, Any]) -> None:
        message = _message(raw)
        if message is not None:
            self._waiting.append(message)

    def _send(self, document: dict[str, Any]) -> None:
        try:
            self._socket.send(json.dumps(document))
        except ConnectionClosed as closed:
            raise _closed(closed) from None

    def _receive(self, timeout_s: float | None) -> dict[str, Any]:
        try:
            raw: dict[str, Any] = json.loads(self._socket.recv(timeout_s))
        except TimeoutError:
            raise Unreachable(self._url, "the stream fell silent") from None
        except ConnectionClosed as closed:
            raise _closed(closed) from None
        if raw["type"] == "error":
            raise Refused(raw["problem"])
        return raw


def _opened(resources: ExitStack, url: str, timeout_s: float) -> ClientConnection:
    address = "ws" + url.removeprefix("http") + PATH
    # Not through a proxy, as with plain requests; compression costs more than it saves.
    options: dict[str, Any] = {"compression": None, "proxy": None, "open_timeout": timeout_s}
    try:
        socket: ClientConnection = resources.enter_context(
            connect(address, subprotocols=[SUBPROTOCOL], **options)
        )
    except (InvalidHandshake, InvalidURI) as error:
        raise NotHapticd(url, f"it opens no stream ({error})") from None
    except OSError as error:
        raise Unreachable(url, error.strerror or "it did not answer in time") from None
    return socket


def _message(raw: dict[str, Any]) -> Message | None:
    """The message, or None for one that a later daemon has invented."""
    match raw["type"]:
        case "data":
            facts = {name: raw[name] for name in ("tick", "t_mono_ns", "count", "dropped", "values")}
            return Data(device_id=raw["sub"], **facts)
        case "snapshot":
            return Snapshot(raw["snapshot"])
        case "event":
            return Happening(raw["event"])
    return None


def _closed(closed: ConnectionClosed) -> StreamClosed:
    frame = closed.rcvd
    return StreamClosed(frame.code, frame.reason) if frame else StreamClosed(1006, "the connection was lost")
