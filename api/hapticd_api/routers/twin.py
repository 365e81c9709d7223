"""What only a twin has: a simulated hand, and faults on demand."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body
from pydantic import RootModel

from hapticd.hand import HandScript
from hapticd.injection import Injection
from hapticd.snapshot import Applied, Report
from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/twin", tags=["twin"])

_WRITE_ERRORS = (
    "device-not-found",
    "not-a-twin",
    "invalid-document",
    "unknown-field",
    "device-offline",
    "servo-silent",
)
_HAND_EXAMPLES: dict[str, Any] = {
    "follow": {"summary": "Go to a point and follow it", "value": {"target_m": [0.18, 0.0, -0.03]}},
    "push": {
        "summary": "Push down with 2 N",
        "value": {"type": "push", "direction": [0, 0, -1], "force_n": 2.0},
    },
    "free": {"summary": "Let go", "value": {"type": "free"}},
}
_INJECTION_EXAMPLES: dict[str, Any] = {
    "unplug": {
        "summary": "Pull the plug for half a second",
        "value": {"type": "unplug", "duration_s": 0.5},
    },
    "drop": {
        "summary": "Lose every tenth frame for 2 s",
        "value": {"type": "drop_frames", "fraction": 0.1, "duration_s": 2.0},
    },
}


class HandDocument(RootModel[HandScript]):
    """What the simulated hand shall do. `{"target_m": […]}` alone is a point to follow."""


class InjectionDocument(RootModel[Injection]):
    """What shall break, and for how long."""


class HandReport(Report):
    """What the simulated hand was told to do."""

    hand: HandScript
    applied: Applied


class InjectionReport(Report):
    """The fault that was injected."""

    injection: Injection
    applied: Applied


@router.get(
    "/hand",
    operation_id="get_hand",
    summary="What the simulated hand does",
    responses=problem_answers("device-not-found", "not-a-twin"),
)
async def get_hand(device: DeviceDep) -> HandDocument:
    """What the hand was last told."""
    return HandDocument(device.hand)


@router.put(
    "/hand",
    operation_id="set_hand",
    summary="Tell the simulated hand what to do",
    responses=problem_answers(*_WRITE_ERRORS, "dimension-mismatch"),
)
async def set_hand(
    device: DeviceDep, script: Annotated[HandDocument, Body(openapi_examples=_HAND_EXAMPLES)]
) -> HandReport:
    """Hold, follow a point, push, stroke, reach, let go. Walls and the device push the hand back."""
    applied = await device.set_hand(script.root)
    return HandReport(hand=device.hand, applied=applied)


@router.post(
    "/faults",
    operation_id="inject_fault",
    summary="Inject a fault into the simulated hardware",
    responses=problem_answers(*_WRITE_ERRORS),
)
async def inject_fault(
    device: DeviceDep, injection: Annotated[InjectionDocument, Body(openapi_examples=_INJECTION_EXAMPLES)]
) -> InjectionReport:
    """Breaks the simulated hardware for a while, to see how everything above it takes that."""
    return InjectionReport(injection=injection.root, applied=await device.inject(injection.root))
