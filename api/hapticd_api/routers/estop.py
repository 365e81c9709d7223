"""The emergency stop, of one device and of all."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable

from fastapi import APIRouter
from pydantic import Field

from hapticd.device import Device
from hapticd.problem import Problem
from hapticd.snapshot import Applied, DeviceState, Report
from hapticd_api.dependencies import DeviceDep, StationDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1", tags=["estop"])

_ERRORS = problem_answers("device-not-found", "device-offline", "servo-silent")


class EstopReport(Report):
    """Whether the emergency stop of a device is latched."""

    device_id: str
    engaged: bool
    state: DeviceState
    applied: Applied | None = Field(None, description="Null when no loop runs that could be told")


class StationEstop(Report):
    """The emergency stops of all devices."""

    engaged: bool = Field(description="Whether any device's emergency stop is latched")
    devices: list[EstopReport]


def _report(device: Device, applied: Applied | None = None) -> EstopReport:
    snapshot = device.snapshot()
    return EstopReport(
        device_id=snapshot.id, engaged=snapshot.flags.estop, state=snapshot.state, applied=applied
    )


def _station_report(reports: Iterable[EstopReport]) -> StationEstop:
    devices = list(reports)
    return StationEstop(engaged=any(report.engaged for report in devices), devices=devices)


async def _each(station: StationDep, act: Callable[[Device], Awaitable[Applied | None]]) -> StationEstop:
    """Acts on every device at once, and only then complains about those that did not answer."""
    devices = list(station.devices.values())
    outcomes = await asyncio.gather(*map(act, devices), return_exceptions=True)
    for outcome in outcomes:
        if isinstance(outcome, BaseException) and not _is_offline(outcome):
            raise outcome
    pairs = zip(devices, outcomes, strict=True)
    return _station_report(
        _report(device, None if isinstance(outcome, BaseException) else outcome) for device, outcome in pairs
    )


def _is_offline(error: BaseException) -> bool:
    return isinstance(error, Problem) and error.slug == "device-offline"


@router.get("/estop", operation_id="get_station_estop", summary="Emergency stops of all devices")
async def get_station_estop(station: StationDep) -> StationEstop:
    """Whether the emergency stop of each device is latched."""
    return _station_report(_report(device) for device in station.devices.values())


@router.put(
    "/estop",
    operation_id="engage_station_estop",
    summary="Stop all devices",
    responses=problem_answers("servo-silent"),
)
async def engage_station_estop(station: StationDep) -> StationEstop:
    """Latches the emergency stop of every device: outputs are zero at the next tick. Needs no body."""
    return await _each(station, lambda device: device.engage_estop())


@router.delete(
    "/estop",
    operation_id="acknowledge_station_estop",
    summary="Acknowledge all emergency stops",
    responses=problem_answers("servo-silent"),
)
async def acknowledge_station_estop(station: StationDep) -> StationEstop:
    """Clears every latch. The devices stay disabled until each is enabled again."""
    return await _each(station, lambda device: device.acknowledge_estop())


@router.get(
    "/devices/{device_id}/estop",
    operation_id="get_estop",
    summary="Emergency stop of one device",
    responses=problem_answers("device-not-found"),
)
async def get_estop(device: DeviceDep) -> EstopReport:
    """Whether the emergency stop is latched."""
    return _report(device)


@router.put(
    "/devices/{device_id}/estop",
    operation_id="engage_estop",
    summary="Stop one device",
    responses=_ERRORS,
)
async def engage_estop(device: DeviceDep) -> EstopReport:
    """Latches the emergency stop: outputs are zero at the next tick. Never needs a lease or a body.

    A device without a servo drives nothing; `applied` is null then, and its next servo starts latched.
    """
    return _report(device, await device.engage_estop())


@router.delete(
    "/devices/{device_id}/estop",
    operation_id="acknowledge_estop",
    summary="Acknowledge an emergency stop",
    responses=_ERRORS,
)
async def acknowledge_estop(device: DeviceDep) -> EstopReport:
    """Clears the latch. The device stays disabled until it is enabled again."""
    return _report(device, await device.acknowledge_estop())
