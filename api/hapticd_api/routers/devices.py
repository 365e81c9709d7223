"""The configured devices."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

from hapticd.snapshot import DeviceSnapshot
from hapticd_api.dependencies import DeviceDep, StationDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices", tags=["devices"])


class DeviceList(BaseModel):
    """Every configured device, in the order of the configuration."""

    devices: list[DeviceSnapshot]


@router.get("", operation_id="list_devices", summary="All devices")
async def list_devices(station: StationDep) -> DeviceList:
    """Every configured device with its traits, state, faults, limits and health."""
    return DeviceList(devices=[device.snapshot() for device in station.devices.values()])


@router.get(
    "/{device_id}",
    operation_id="get_device",
    summary="One device",
    responses=problem_answers("device-not-found"),
)
async def get_device(device: DeviceDep) -> DeviceSnapshot:
    """One device with its traits, state, faults, limits and health."""
    return device.snapshot()
