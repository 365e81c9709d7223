"""The state of a device: enabled, disabled or paused."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from pydantic import Field

from hapticd.device import Device
from hapticd.document import Document
from hapticd.snapshot import Applied, DeviceState, FaultReport, Flags, InterlockReport, Report
from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/state", tags=["state"])


class StateRequest(Document):
    """The state a device shall go to."""

    desired: Literal["enabled", "disabled", "paused"] = Field(examples=["enabled"])


class StateReport(Report):
    """The state a device is in, and what keeps it from being enabled."""

    device_id: str
    state: DeviceState
    flags: Flags
    faults: list[FaultReport]
    interlocks: list[InterlockReport] = Field(description="Those that are open")
    applied: Applied | None = None


def state_report(device: Device, applied: Applied | None = None) -> StateReport:
    """The state of `device` now, with the outcome of a write."""
    snapshot = device.snapshot()
    return StateReport(
        device_id=snapshot.id,
        state=snapshot.state,
        flags=snapshot.flags,
        faults=snapshot.faults,
        interlocks=[interlock for interlock in snapshot.interlocks if not interlock.ok],
        applied=applied,
    )


@router.get(
    "",
    operation_id="get_state",
    summary="State of a device",
    responses=problem_answers("device-not-found"),
)
async def get_state(device: DeviceDep) -> StateReport:
    """The state now, the latched faults, and the interlocks that are open."""
    return state_report(device)


@router.put(
    "",
    operation_id="set_state",
    summary="Enable, disable or pause",
    responses=problem_answers(
        "device-not-found",
        "invalid-document",
        "interlock-open",
        "state-refused",
        "device-offline",
        "servo-silent",
    ),
)
async def set_state(device: DeviceDep, request: StateRequest) -> StateReport:
    """Asks for a state. Enabling ramps forces up, leaving it fades them out. 409 names open interlocks."""
    applied = await device.set_desired(request.desired)
    return state_report(device, applied)
