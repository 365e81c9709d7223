"""The two WebSockets: the stream, and the telemetry of one device for a quick look."""

from __future__ import annotations

import asyncio
from contextlib import AbstractContextManager

from fastapi import APIRouter, WebSocket
from prometheus_client import Gauge

from hapticd.problem import Problem
from hapticd.station import Station
from hapticd.telemetry import Subscription
from hapticd_api.dependencies import station_of
from hapticd_api.stream.close import REASONS, CloseCode
from hapticd_api.stream.codec import Codec, Undecodable, negotiated
from hapticd_api.stream.connection import Closing, Connection, first_closing
from hapticd_api.stream.quick_look import QuickLook
from hapticd_api.stream.session import Session
from hapticd_api.stream.shutdown import until_stopped

router = APIRouter()

QUICK_LOOK_ID = "telemetry"
"""Subscription name in the messages of the quick look."""


@router.websocket("/api/v1/stream")
async def stream(websocket: WebSocket) -> None:
    """Every device's signals, snapshots and events; see /asyncapi.json."""
    connection = await _accepted(websocket)
    if connection is not None:
        with _counted(websocket):
            await Session(station_of(websocket), connection).run()


@router.websocket("/api/v1/devices/{device_id}/telemetry")
async def telemetry(websocket: WebSocket, device_id: str) -> None:
    """Signals of one device from the first message on, without a handshake; see /asyncapi.json."""
    connection = await _accepted(websocket)
    if connection is None:
        return
    with _counted(websocket):
        try:
            wish = QuickLook.asked(websocket.query_params)
            await _quick_look(station_of(websocket), device_id, wish, connection)
        except Problem as problem:
            await connection.send_problem(problem)
            await connection.close(CloseCode.BAD_REQUEST)


async def _quick_look(station: Station, device_id: str, wish: QuickLook, connection: Connection) -> None:
    device = station.device(device_id)
    code: CloseCode | None = None
    with station.telemetry[device.device_id].subscribe(wish.signals, wish.rate_hz, wish.mode) as subscription:
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(_pump(connection, subscription))
                tasks.create_task(_ignore(connection))
                tasks.create_task(until_stopped(station.events))
        except* Closing as ended:
            code = first_closing(ended).code
    if code is not None:
        await connection.close(code)


async def _pump(connection: Connection, subscription: Subscription) -> None:
    while True:
        await connection.send_data(QUICK_LOOK_ID, await subscription.next())


async def _ignore(connection: Connection) -> None:
    """Takes what the client says, so that its leaving is noticed."""
    while True:
        try:
            await connection.receive()
        except Undecodable:
            continue


async def _accepted(websocket: WebSocket) -> Connection | None:
    """The connection, once accepted; None when the two sides have no subprotocol in common."""
    offered: list[str] = websocket.scope.get("subprotocols", [])
    codec: Codec | None = negotiated(offered)
    await websocket.accept(subprotocol=codec.subprotocol if codec is not None and offered else None)
    if codec is None:
        await websocket.close(CloseCode.VERSION, REASONS[CloseCode.VERSION])
        return None
    return Connection(websocket, codec)


def _counted(websocket: WebSocket) -> AbstractContextManager[None]:
    streams: Gauge = websocket.app.state.streams
    return streams.track_inprogress()
