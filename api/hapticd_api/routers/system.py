"""How well the loops keep time."""

from __future__ import annotations

from fastapi import APIRouter

from hapticd.realtime import RealtimeReport
from hapticd.snapshot import Report
from hapticd_api.dependencies import StationDep

router = APIRouter(prefix="/api/v1/system", tags=["system"])


class SystemRealtime(Report):
    """The timing of every loop by device; null for a device whose servo has not reported yet."""

    devices: dict[str, RealtimeReport | None]


@router.get("/realtime", operation_id="get_realtime", summary="Real-time behaviour")
async def get_realtime(station: StationDep) -> SystemRealtime:
    """The scheduling really obtained, histograms of every phase of a tick, and the deadlines missed."""
    return SystemRealtime(
        devices={device_id: device.realtime() for device_id, device in station.devices.items()}
    )
