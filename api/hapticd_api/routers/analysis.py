"""What a device can render: its stability budget for a law, and the stiffness of its tip."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Query
from pydantic import Field

from hapticd.analysis.stability import StabilityBudget
from hapticd.analysis.tip_stiffness import TipStiffness, tip_stiffness
from hapticd.device import Device
from hapticd.document import Document
from hapticd.laws import Law
from hapticd.problem import Problem
from hapticd.vector import AXES
from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/analysis", tags=["analysis"])

RATE_RANGE_HZ = (200.0, 10_000.0)
DELAY_MAX_S = 0.1

_STABILITY_EXAMPLES: dict[str, Any] = {
    "spring": {
        "summary": "A spring of 1 N/mm with a little damping",
        "value": {"law": {"type": "spring", "stiffness_n_per_m": 1000.0, "damping_n_s_per_m": 2.0}},
    },
    "faster": {
        "summary": "A rigid wall, were the loop to run at 4 kHz",
        "value": {"law": {"type": "motion", "eta": 0.0}, "rate_hz": 4000.0},
    },
}


class StabilityQuestion(Document):
    """A law, and the loop it would run in; what is left out is as the device has it now."""

    law: Law
    rate_hz: Annotated[float, Field(ge=RATE_RANGE_HZ[0], le=RATE_RANGE_HZ[1])] | None = Field(
        None, description="Rate of the loop, Hz; by default the configured one"
    )
    delay_s: Annotated[float, Field(ge=0.0, le=DELAY_MAX_S)] | None = Field(
        None, description="From the encoders' latch to the actuators, s; by default one tick and the exchange"
    )


@router.post(
    "/stability",
    operation_id="analyse_stability",
    summary="How stiff a wall may be",
    responses=problem_answers("device-not-found", "invalid-document", "unknown-field"),
)
async def analyse_stability(
    device: DeviceDep, question: Annotated[StabilityQuestion, Body(openapi_examples=_STABILITY_EXAMPLES)]
) -> StabilityBudget:
    """The largest passive, linearly stable and simulated-stable stiffness, the margin, what would raise it.

    Nothing is changed. `largest_simulated_n_per_m` is null while the twin is being simulated, which takes
    seconds once for a model, a rate and a delay.
    """
    loop = device.stability.loop(question.rate_hz, question.delay_s)
    return device.stability.budget(question.law, loop, advice=True)


@router.get(
    "/stiffness",
    operation_id="analyse_stiffness",
    summary="How stiff the tip is",
    responses=problem_answers("device-not-found", "device-offline", "invalid-document", "dimension-mismatch"),
)
async def analyse_stiffness(
    device: DeviceDep,
    q: Annotated[
        str | None,
        Query(
            description="Joint angles, rad, separated by commas; by default the present ones",
            examples=["0,0.9,0.9"],
        ),
    ] = None,
) -> TipStiffness:
    """Ellipsoid of the inverse mapping, ball of the transpose mapping, α and k_c at a pose (WN Fig. 3)."""
    try:
        return tip_stiffness(device.model, _angles(device, q))
    except ValueError as error:
        raise Problem("invalid-document", str(error), pointer="/q", device_id=device.device_id) from None


def _angles(device: Device, q: str | None) -> list[float]:
    if q is None:
        angles = device.joint_angles_rad
        if angles is None:
            detail = f"{device.device_id} is offline: its pose is not known. Give one: ?q=."
            raise Problem("device-offline", detail, device_id=device.device_id, current_state="offline")
        return angles
    angles = [_angle(part) for part in q.split(",")]
    if len(angles) != device.dof:
        detail = f"q has {len(angles)} angles, this device has {device.dof} joints."
        raise Problem("dimension-mismatch", detail, pointer="/q", device_id=device.device_id)
    return angles + [0.0] * (AXES - device.dof)


def _angle(text: str) -> float:
    try:
        angle = float(text)
    except ValueError:
        raise ValueError(f"{text!r} is no number.") from None
    if not abs(angle) < 100.0:
        raise ValueError(f"{text} is no joint angle; write radians.")
    return angle
