"""Where everything is."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel

from hapticd.signals import signals
from hapticd_api.dependencies import StationDep
from hapticd_api.release import release
from hapticd_api.stream.codec import CODECS

router = APIRouter(prefix="/api/v1", tags=["system"])


class SignalReport(BaseModel):
    """A signal that can be subscribed to. `shape` is empty for a number, `[3]` for a vector."""

    name: str
    unit: str
    shape: list[int]
    kind: Literal["float", "integer"]
    meaning: str


class Index(BaseModel):
    """What this daemon is, and where its resources are."""

    version: str
    api_version: int
    boot_id: str
    devices: list[str]
    links: dict[str, str]
    stream_subprotocols: list[str]
    signals: list[SignalReport]


_LINKS = {
    "devices": "/api/v1/devices",
    "estop": "/api/v1/estop",
    "events": "/api/v1/events",
    "experiments": "/api/v1/experiments",
    "jobs": "/api/v1/jobs",
    "realtime": "/api/v1/system/realtime",
    "stream": "/api/v1/stream",
    "live": "/livez",
    "ready": "/readyz",
    "metrics": "/metrics",
    "problems": "/problems",
    "docs": "/docs",
    "openapi": "/openapi.json",
    "asyncapi": "/asyncapi.json",
}


@router.get("", operation_id="get_index", summary="Index")
async def get_index(station: StationDep) -> Index:
    """Version, boot id, links, and every signal a stream can carry."""
    return Index(
        version=release(),
        api_version=1,
        boot_id=station.boot_id,
        devices=list(station.devices),
        links=_LINKS,
        stream_subprotocols=list(CODECS),
        signals=[
            SignalReport(
                name=signal.name,
                unit=signal.unit,
                shape=list(signal.shape),
                kind=signal.kind,
                meaning=signal.meaning,
            )
            for signal in signals().values()
        ],
    )
