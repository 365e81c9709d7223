"""Why a device cannot be enabled, and what to do about it."""

from __future__ import annotations

from fastapi import APIRouter

from hapticd.snapshot import InterlockReport, Report
from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/interlocks", tags=["state"])


class InterlockList(Report):
    """Every condition for enabling a device."""

    interlocks: list[InterlockReport]


@router.get(
    "",
    operation_id="list_interlocks",
    summary="Conditions for enabling",
    responses=problem_answers("device-not-found"),
)
async def list_interlocks(device: DeviceDep) -> InterlockList:
    """Every condition for enabling; those with `ok: false` keep the device from it and name their cure."""
    return InterlockList(interlocks=device.snapshot().interlocks)
