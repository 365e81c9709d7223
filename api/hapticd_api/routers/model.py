"""The numbers of a device: geometry, joints, drives, brakes, limits."""

from __future__ import annotations

from typing import Any

import orjson
from fastapi import APIRouter

from hapticd_api.dependencies import DeviceDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/model", tags=["devices"])


@router.get(
    "",
    operation_id="get_model",
    summary="The device's numbers",
    responses=problem_answers("device-not-found"),
)
async def get_model(device: DeviceDep) -> dict[str, Any]:
    """The model in force, the configuration's overrides included: SI units, joint angles in radians."""
    model: dict[str, Any] = orjson.loads(device.model.device_json)
    return model
