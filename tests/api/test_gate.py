"""Only pages of the daemon itself, and programs, may change or stream a device."""

from __future__ import annotations

import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from tests.api.test_problems import problem_of

ESTOP = "/api/v1/devices/phantom/estop"


@pytest.mark.parametrize("host", ["localhost:8420", "127.0.0.1:8420", "[::1]:8420", "127.8.8.8"])
async def test_loop_back_names_are_answered(http: httpx.AsyncClient, host: str) -> None:
    assert (await http.get("/livez", headers={"Host": host})).status_code == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "", "[::1"]
)
async def test_other_host_names_are_refused_also_for_reading(http: httpx.AsyncClient, host: str) -> None:
    problem_of(await http.get("/api/v1/devices", headers={"Host": host}), 421, "host-not-allowed")


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "null",
        "http://localhost:3000",
        "http://localhost:8420.evil.example",
        "http://[",
    ],
)
async def test_write_from_another_origin_is_refused(http: httpx.AsyncClient, origin: str) -> None:
    problem_of(await http.put(ESTOP, headers={"Origin": origin}), 403, "origin-not-allowed")


async def test_write_from_the_daemons_own_page_is_taken(http: httpx.AsyncClient) -> None:
    response = await http.put(ESTOP, headers={"Origin": "http://localhost:8420"})
    assert response.status_code == 200


async def test_reading_from_another_origin_gets_no_permission_to_look(http: httpx.AsyncClient) -> None:
    response = await http.get("/api/v1/devices", headers={"Origin": "http://evil.example"})
    assert not [name for name in response.headers if name.startswith("access-control-")]


@pytest.mark.parametrize("path", ["/api/v1/stream", "/api/v1/devices/phantom/telemetry"])
async def test_websocket_from_another_origin_is_closed_with_1008(address: str, path: str) -> None:
    async with connect(f"ws://{address}{path}", origin="http://evil.example") as stream:
        with pytest.raises(ConnectionClosed) as closed:
            await stream.recv()
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == 1008
    assert "evil.example" in closed.value.rcvd.reason


async def test_every_response_forbids_other_hosts_and_frames(http: httpx.AsyncClient) -> None:
    for path in ("/", "/docs", "/api/v1", "/api/v1/nothing"):
        policy = (await http.get(path)).headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "http" not in policy
