"""The whole scene of a device."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body
from starlette.responses import Response

from hapticd.scene import Scene
from hapticd.scene_result import SceneResult
from hapticd_api.conditional import conditional, tagged
from hapticd_api.dependencies import DeviceDep, EditTerms, IfNoneMatch
from hapticd_api.document import checked, merged
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/devices/{device_id}/scene", tags=["scene"])

_ERRORS = problem_answers(
    "device-not-found",
    "invalid-document",
    "unknown-field",
    "dimension-mismatch",
    "no-brakes",
    "over-stability-budget",
    "too-many-walls",
    "revision-stale",
    "storage-failed",
    "servo-silent",
)

_PATCH_EXAMPLES = {
    "mapping": {"summary": "Another joint mapping, the walls as they are", "value": {"mapping": "inverse"}},
    "empty": {"summary": "No walls at all", "value": {"walls": []}},
}


@router.get(
    "",
    operation_id="get_scene",
    summary="The scene",
    response_model=Scene,
    responses={**problem_answers("device-not-found"), 304: {"description": "The caller's copy still holds"}},
)
async def get_scene(device: DeviceDep, if_none_match: IfNoneMatch = None) -> Response:
    """The scene as it was written, ready to be edited and sent back. Its `ETag` is its revision."""
    return conditional(device.scene, device.scene_etag, if_none_match)


@router.put(
    "",
    operation_id="replace_scene",
    summary="Replace the scene",
    response_model=SceneResult,
    responses=_ERRORS,
)
async def replace_scene(device: DeviceDep, scene: Scene, terms: EditTerms) -> Response:
    """Replaces the scene whole, at one tick, cross-faded so that no force steps."""
    result = await device.replace_scene(scene, terms)
    return tagged(result, result.etag)


@router.patch(
    "",
    operation_id="patch_scene",
    summary="Change part of the scene",
    response_model=SceneResult,
    responses=_ERRORS,
)
async def patch_scene(
    device: DeviceDep,
    patch: Annotated[dict[str, Any], Body(openapi_examples=_PATCH_EXAMPLES)],
    terms: EditTerms,
) -> Response:
    """Merges a JSON merge patch (RFC 7396) into the scene; what it does not name stays, lists are whole."""

    def change(scene: Scene) -> Scene:
        return checked(Scene, merged(scene.model_dump(mode="json"), patch))

    result = await device.edit_scene(change, terms)
    return tagged(result, result.etag)
