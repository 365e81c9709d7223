"""The stream: handshake, subscriptions, events, and what it does to clients that misbehave."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

import httpx
import msgpack
import orjson
import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from hapticd_api.stream import session
from tests.api.conftest import Rig

JSON = Subprotocol("hapticd.v1+json")
MSGPACK = Subprotocol("hapticd.v1+msgpack")
TIP = {"type": "subscribe", "id": "tip", "device": "phantom", "signals": ["tick", "tip_position_m"]}


class Client:
    """A client of the stream in either encoding."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self._binary = connection.subprotocol == MSGPACK

    async def say(self, **message: Any) -> None:
        await self.connection.send(msgpack.packb(message) if self._binary else orjson.dumps(message).decode())

    async def hear(self) -> dict[str, Any]:
        async with asyncio.timeout(5):
            payload = await self.connection.recv()
        message = msgpack.unpackb(payload) if self._binary else orjson.loads(payload)
        assert isinstance(message, dict)
        return message

    async def hear_until(self, kind: str) -> dict[str, Any]:
        """The next message of this type; others are passed over."""
        while (message := await self.hear())["type"] != kind:
            pass
        return message

    async def closing_code(self) -> int:
        """The code the daemon closes with, after whatever it still had to say."""
        async with asyncio.timeout(5):
            with suppress(ConnectionClosed):
                async for _ in self.connection:
                    continue
        assert self.connection.close_code is not None
        return self.connection.close_code


@asynccontextmanager
async def streaming(address: str, subprotocol: Subprotocol = JSON) -> AsyncIterator[Client]:
    """A client that has been welcomed."""
    async with connect(f"ws://{address}/api/v1/stream", subprotocols=[subprotocol]) as connection:
        client = Client(connection)
        await client.say(type="hello")
        assert (await client.hear())["type"] == "welcome"
        yield client


async def test_welcome_tells_what_there_is_to_see(address: str) -> None:
    async with connect(f"ws://{address}/api/v1/stream", subprotocols=[JSON]) as connection:
        client = Client(connection)
        await client.say(type="hello", client="test")
        welcome = await client.hear()
    assert connection.subprotocol == JSON
    assert [device["id"] for device in welcome["devices"]] == ["phantom", "hhd", "bench"]
    signal = next(entry for entry in welcome["signals"] if entry["name"] == "tip_position_m")
    assert (signal["unit"], signal["shape"]) == ("m", [3])
    assert welcome["clock"]["t_mono_ns"] > 0


async def test_grant_and_snapshot_come_before_data(address: str) -> None:
    async with streaming(address) as client:
        await client.say(**TIP, rate_hz=1000)
        messages = [await client.hear() for _ in range(3)]
    assert [message["type"] for message in messages] == ["result", "snapshot", "data"]
    assert messages[0]["rate_hz"] == 60.0
    assert messages[1]["snapshot"]["state"] == "disabled"


@pytest.mark.parametrize("subprotocol", [JSON, MSGPACK])
async def test_batch_carries_every_tick_once(address: str, subprotocol: Subprotocol) -> None:
    ticks: list[int] = []
    async with streaming(address, subprotocol) as client:
        await client.say(**TIP, mode="batch", rate_hz=30)
        for sequence in range(6):
            data = await client.hear_until("data")
            assert (data["sub"], data["seq"], data["dropped"]) == ("tip", sequence, 0)
            assert data["tick"] == data["values"]["tick"][0]
            assert data["count"] == len(data["values"]["tip_position_m"])
            ticks += data["values"]["tick"]
    assert ticks == list(range(ticks[0], ticks[0] + len(ticks)))


@pytest.mark.parametrize("subprotocol", [JSON, MSGPACK])
async def test_latest_carries_plain_values_and_null_for_not_finite(
    address: str, rig: Rig, subprotocol: Subprotocol
) -> None:
    rig.servos["phantom"].force_is_nan = True
    async with streaming(address, subprotocol) as client:
        await client.say(**{**TIP, "signals": ["tip_position_m", "tip_force_n", "contact_wall"]})
        values = (await client.hear_until("data"))["values"]
    assert values == {
        "tip_position_m": [0.197, 0.0, 0.023],
        "tip_force_n": [None, None, None],
        "contact_wall": -1,
    }


async def test_unsubscribed_signals_stop(address: str, rig: Rig) -> None:
    async with streaming(address) as client:
        await client.say(**TIP)
        await client.hear_until("data")
        await client.say(type="unsubscribe", id="tip")
        while (await client.hear())["type"] != "result":
            pass
        await client.say(type="ping", nonce="after")
        assert (await client.hear())["type"] == "pong"
        assert rig.station.telemetry["phantom"].subscribers == 0


async def test_leaving_client_frees_its_subscriptions(address: str, rig: Rig) -> None:
    async with streaming(address) as client:
        await client.say(**TIP)
        await client.hear_until("data")
        assert rig.station.telemetry["phantom"].subscribers == 1
    async with asyncio.timeout(5):
        while rig.station.telemetry["phantom"].subscribers:  # noqa: ASYNC110 - the server's task does it
            await asyncio.sleep(0.01)


async def test_edit_is_heard_as_event_and_snapshot_by_those_who_watch(
    address: str, http: httpx.AsyncClient
) -> None:
    async with streaming(address) as client:
        await client.say(**TIP)
        await client.hear_until("snapshot")
        await http.put("/api/v1/devices/phantom/scene", json={"mapping": "inverse"})
        event = (await client.hear_until("event"))["event"]
        snapshot = (await client.hear_until("snapshot"))["snapshot"]
    assert (event["kind"], event["device_id"]) == ("scene.changed", "phantom")
    assert snapshot["scene_revision"] == event["details"]["revision"]


@pytest.mark.parametrize(
    ("change", "slug", "pointer"),
    [
        ({"device": "fantom"}, "device-not-found", None),
        ({"signals": ["tip"]}, "signal-unknown", None),
        ({"signals": []}, "invalid-document", "/signals"),
        ({"rate_hz": 0}, "invalid-document", "/rate_hz"),
        ({"mode": "all"}, "invalid-document", "/mode"),
        ({"colour": "red"}, "unknown-field", "/colour"),
        ({"type": "subscibe"}, "invalid-document", None),
    ],
)
async def test_bad_request_is_answered_and_the_stream_goes_on(
    address: str, change: dict[str, Any], slug: str, pointer: str | None
) -> None:
    async with streaming(address) as client:
        await client.say(**{**TIP, **change})
        problem = (await client.hear_until("error"))["problem"]
        assert problem["type"] == f"/problems/{slug}"
        assert pointer is None or problem["pointer"] == pointer
        await client.say(type="ping", nonce="still here")
        assert (await client.hear_until("pong"))["nonce"] == "still here"


async def test_subscription_name_cannot_be_taken_twice(address: str) -> None:
    async with streaming(address) as client:
        await client.say(**TIP)
        await client.say(**TIP)
        error = await client.hear_until("error")
    assert (error["request"], error["id"]) == ("subscribe", "tip")


async def test_text_that_is_not_json_is_answered(address: str) -> None:
    async with streaming(address) as client:
        await client.connection.send("{")
        assert (await client.hear())["problem"]["type"] == "/problems/malformed-json"


async def test_first_message_must_be_hello(address: str) -> None:
    async with connect(f"ws://{address}/api/v1/stream") as connection:
        client = Client(connection)
        await client.say(**TIP)
        assert "hello" in (await client.hear())["problem"]["detail"]
        await client.say(type="hello")
        assert (await client.hear())["type"] == "welcome"


async def test_silent_client_is_closed(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "HELLO_TIMEOUT_S", 0.05)
    async with connect(f"ws://{address}/api/v1/stream") as connection:
        assert await Client(connection).closing_code() == 4408


async def test_client_of_another_version_is_closed(address: str) -> None:
    async with connect(f"ws://{address}/api/v1/stream", subprotocols=[JSON]) as connection:
        client = Client(connection)
        await client.say(type="hello", version=2)
        assert await client.closing_code() == 4426


async def test_client_without_a_common_subprotocol_is_closed(address: str) -> None:
    url = f"ws://{address}/api/v1/stream"
    # The client library itself refuses a server that picks no subprotocol only when one is demanded.
    async with connect(url, subprotocols=[Subprotocol("hapticd.v9+json")]) as connection:
        assert await Client(connection).closing_code() == 4426


async def test_message_past_the_limit_closes(address: str) -> None:
    async with streaming(address) as client:
        await client.connection.send(" " * 70_000)
        assert await client.closing_code() == 1009


async def test_client_that_cannot_keep_up_with_events_is_closed(address: str, rig: Rig) -> None:
    async with streaming(address) as client:
        for number in range(2000):
            rig.station.events.append("test", f"Event {number}.")
        assert await client.closing_code() == 1013


@pytest.mark.parametrize("path", ["/api/v1/stream", "/api/v1/devices/phantom/telemetry"])
async def test_stopping_daemon_says_so(address: str, rig: Rig, path: str) -> None:
    async with connect(f"ws://{address}{path}") as connection:
        client = Client(connection)
        await client.say(type="hello")
        await client.hear()
        rig.station.events.append("daemon.stopped", "The daemon stopped.")
        assert await client.closing_code() == 1001


async def test_quick_look_sends_data_without_a_handshake(address: str) -> None:
    query = "signals=tick,tip_position_m&rate_hz=60&mode=batch"
    async with connect(f"ws://{address}/api/v1/devices/phantom/telemetry?{query}") as connection:
        client = Client(connection)
        frames = [await client.hear() for _ in range(3)]
    ticks = [tick for frame in frames for tick in frame["values"]["tick"]]
    assert ticks == list(range(ticks[0], ticks[0] + len(ticks)))
    assert {frame["type"] for frame in frames} == {"data"}


@pytest.mark.parametrize(
    ("path", "slug"),
    [
        ("fantom/telemetry", "device-not-found"),
        ("phantom/telemetry?signals=tip", "signal-unknown"),
        ("phantom/telemetry?rate_hz=fast", "invalid-document"),
        ("phantom/telemetry?rate_hz=nan", "invalid-document"),
        ("phantom/telemetry?rate=60", "unknown-field"),
    ],
)
async def test_quick_look_that_cannot_be_served_says_why(address: str, path: str, slug: str) -> None:
    async with connect(f"ws://{address}/api/v1/devices/{path}") as connection:
        client = Client(connection)
        assert (await client.hear())["problem"]["type"] == f"/problems/{slug}"
        assert await client.closing_code() == 4400
