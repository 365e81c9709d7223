"""The stream: the handshake, what is asked for, and how an end is told."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

from hapticd_client import NotHapticd, Refused, StreamClosed, Unreachable, open_stream
from hapticd_client.stream import Data, Happening, Snapshot
from tests.clients.daemon_double import device, problem

WELCOME = {"type": "welcome", "version": 1, "devices": [{"id": "phantom"}, {"id": "hhd"}], "signals": []}
DATA = {
    "type": "data",
    "sub": "phantom",
    "seq": 0,
    "tick": 5,
    "t_mono_ns": 9,
    "count": 1,
    "dropped": 0,
    "values": {},
}
EVENT = {"id": 1, "t_utc": "2026-01-01T00:00:00Z", "kind": "state", "message": "Enabled."}

Say = Callable[[dict[str, Any]], None]
Hear = Callable[[], dict[str, Any]]


@contextmanager
def listening(handle: Callable[[ServerConnection], None], **options: Any) -> Iterator[str]:
    """The address of a WebSocket server on this machine."""
    with serve(
        handle, "127.0.0.1", 0, subprotocols=["hapticd.v1+json"], compression=None, **options
    ) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        host, port = server.socket.getsockname()[:2]
        try:
            yield f"http://{host}:{port}"
        finally:
            server.shutdown()
            thread.join()


@contextmanager
def daemon(talk: Callable[[Say, Hear], None]) -> Iterator[str]:
    """The address of a stream that holds a conversation, then waits for the client to leave."""

    def handle(connection: ServerConnection) -> None:
        try:
            talk(
                lambda document: connection.send(json.dumps(document)), lambda: json.loads(connection.recv())
            )
            connection.recv()
        except ConnectionClosed:
            return

    with listening(handle) as url:
        yield url


@pytest.fixture
def heard() -> list[dict[str, Any]]:
    """What the daemon was told."""
    return []


@pytest.fixture
def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port: int = listener.getsockname()[1]
        return port


def test_hello_comes_first_and_the_devices_are_known(heard: list[dict[str, Any]]) -> None:
    def talk(say: Say, hear: Hear) -> None:
        heard.append(hear())
        say(WELCOME)

    with daemon(talk) as url, open_stream(url) as stream:
        assert stream.device_ids == ["phantom", "hhd"]
    assert (heard[0]["type"], heard[0]["version"]) == ("hello", 1)


def test_messages_come_typed_and_in_order_also_those_sent_while_subscribing(
    heard: list[dict[str, Any]],
) -> None:
    def talk(say: Say, hear: Hear) -> None:
        hear()
        say(WELCOME)
        say({"type": "event", "event": EVENT})
        heard.append(hear())
        say({"type": "result", "request": "subscribe", "id": "phantom"})
        say({"type": "snapshot", "device": "phantom", "snapshot": device()})
        say({"type": "news of a later version"})
        say(DATA)

    with daemon(talk) as url, open_stream(url) as stream:
        stream.subscribe("phantom", ["tip_force_n"], rate_hz=10.0, mode="batch")
        messages = iter(stream)
        assert next(messages) == Happening(EVENT)
        assert next(messages) == Snapshot(device())
        assert next(messages) == Data("phantom", tick=5, t_mono_ns=9, count=1, dropped=0, values={})
    wish = {
        "id": "phantom",
        "device": "phantom",
        "signals": ["tip_force_n"],
        "rate_hz": 10.0,
        "mode": "batch",
    }
    assert heard[0] == {"type": "subscribe", **wish}


def test_a_signal_that_does_not_exist_is_refused() -> None:
    def talk(say: Say, hear: Hear) -> None:
        hear()
        say(WELCOME)
        hear()
        say(
            {
                "type": "error",
                "request": "subscribe",
                "id": "phantom",
                "problem": problem("signal-unknown", 422),
            }
        )

    with daemon(talk) as url, open_stream(url) as stream, pytest.raises(Refused) as caught:
        stream.subscribe("phantom", ["tip_farce_n"])
    assert caught.value.slug == "signal-unknown"


@pytest.mark.parametrize(("code", "final"), [(1001, False), (1013, False), (1008, True), (4426, True)])
def test_the_close_code_tells_whether_to_try_again(code: int, final: bool) -> None:
    def handle(connection: ServerConnection) -> None:
        connection.recv()
        connection.send(json.dumps(WELCOME))
        connection.close(code, "a reason")

    with (
        listening(handle) as url,
        open_stream(url) as stream,
        pytest.raises(StreamClosed, match="a reason") as caught,
    ):
        next(iter(stream))
    assert (caught.value.code, caught.value.final) == (code, final)


def test_no_daemon_is_unreachable(free_port: int) -> None:
    with pytest.raises(Unreachable), open_stream(f"http://127.0.0.1:{free_port}"):
        pytest.fail("opened")


def test_a_server_without_streams_is_not_taken_for_a_daemon() -> None:
    def refuse(connection: ServerConnection, _: object) -> Any:
        return connection.respond(404, "nothing here\n")

    with (
        listening(lambda _: None, process_request=refuse) as url,
        pytest.raises(NotHapticd),
        open_stream(url),
    ):
        pytest.fail("opened")


def test_a_daemon_that_never_welcomes_does_not_hang_the_client(heard: list[dict[str, Any]]) -> None:
    with (
        daemon(lambda say, hear: heard.append(hear())) as url,
        pytest.raises(Unreachable, match="fell silent"),
        open_stream(url, timeout_s=0.2),
    ):
        pytest.fail("opened")
