"""A station whose devices have fake servos, and the API over it."""

from __future__ import annotations

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
import uvicorn
from fastapi import FastAPI

from hapticd.config import Config, DeviceConfig, PathsConfig
from hapticd.station import Station
from hapticd_api import create_app
from tests.api.fake_servo import FakeServo

DEVICES = (
    DeviceConfig(id="phantom", model="phantom-1.0"),
    DeviceConfig(id="hhd", model="hhd"),
    DeviceConfig(id="bench", model="hhd", driver="hapticd_io"),
)


@dataclass
class Rig:
    """The station, its API, and the fakes behind it."""

    station: Station
    app: FastAPI
    servos: dict[str, FakeServo]


@pytest.fixture
async def rig(tmp_path: Path) -> AsyncIterator[Rig]:
    """`phantom` and `hhd` are online twins, `bench` is hardware and offline."""
    paths = PathsConfig(state_dir=tmp_path / "state", runtime_dir=tmp_path / "run")
    station = Station(Config(paths=paths, devices=DEVICES))
    servos = {device_id: FakeServo(device_id) for device_id in ("phantom", "hhd")}
    for device_id, servo in servos.items():
        station.devices[device_id].attach(servo)
    pumps = [asyncio.create_task(telemetry.run()) for telemetry in station.telemetry.values()]
    yield Rig(station, create_app(station), servos)
    for pump in pumps:
        pump.cancel()
    await asyncio.gather(*pumps, return_exceptions=True)


@pytest.fixture
async def http(rig: Rig) -> AsyncIterator[httpx.AsyncClient]:
    """Calls the API without a network. An error nobody foresaw is answered, not raised."""
    transport = httpx.ASGITransport(app=rig.app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://localhost:8420") as client:
        yield client


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> contextlib.Generator[None]:
        yield


@pytest.fixture
async def address(rig: Rig) -> AsyncIterator[str]:
    """Host and port of a real server, as the daemon runs it."""
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(
        rig.app, ws="websockets-sansio", ws_per_message_deflate=False, log_config=None, lifespan="off"
    )
    server = _Server(config)
    serving = asyncio.create_task(server.serve(sockets=[listener]))
    host, port = listener.getsockname()
    yield f"{host}:{port}"
    server.should_exit = True
    await serving
    listener.close()
