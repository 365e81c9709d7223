"""Latched faults of a device, and their acknowledgement."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from hapticd.device import Device
from hapticd.problem import Problem
from hapticd.snapshot import Applied, FaultReport, Report
from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/faults", tags=["faults"])

FaultId = Annotated[str, Path(description="Id of a latched fault", examples=["encoder-jump"])]


class FaultList(Report):
    """The faults a device has latched."""

    faults: list[FaultReport]


class Acknowledgement(Report):
    """An acknowledged fault. The device stays disabled until it is enabled again."""

    acknowledged: str
    applied: Applied


def _latched(device: Device, fault_id: str) -> FaultReport:
    faults = device.snapshot().faults
    for fault in faults:
        if fault.id == fault_id:
            return fault
    raise Problem(
        "fault-not-found",
        f"Device {device.device_id!r} has not latched the fault {fault_id!r}.",
        device_id=device.device_id,
        allowed=[fault.id for fault in faults],
    )


@router.get(
    "",
    operation_id="list_faults",
    summary="Latched faults",
    responses=problem_answers("device-not-found"),
)
async def list_faults(device: DeviceDep) -> FaultList:
    """Every latched fault with its severity, cause and cure."""
    return FaultList(faults=device.snapshot().faults)


@router.get(
    "/{fault_id}",
    operation_id="get_fault",
    summary="One latched fault",
    responses=problem_answers("device-not-found", "fault-not-found"),
)
async def get_fault(device: DeviceDep, fault_id: FaultId) -> FaultReport:
    """A latched fault with its severity, cause and cure."""
    return _latched(device, fault_id)


@router.delete(
    "/{fault_id}",
    operation_id="acknowledge_fault",
    summary="Acknowledge a fault",
    responses=problem_answers("device-not-found", "fault-not-found", "device-offline", "servo-silent"),
)
async def acknowledge_fault(device: DeviceDep, fault_id: FaultId) -> Acknowledgement:
    """Clears the latch. If the cause persists, the fault is latched again at the next tick."""
    _latched(device, fault_id)
    return Acknowledgement(acknowledged=fault_id, applied=await device.acknowledge_fault(fault_id))
