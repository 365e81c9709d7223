"""The walls of a device's scene, one by one."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body
from starlette.responses import Response

from hapticd.device import Device
from hapticd.friction import Friction
from hapticd.laws import Law
from hapticd.problem import Problem
from hapticd.scene_result import Granted, SceneResult
from hapticd.shapes import Shape
from hapticd.snapshot import Applied, Report
from hapticd.wall import Wall
from hapticd_api.conditional import conditional, tagged
from hapticd_api.dependencies import DeviceDep, EditTerms, IfNoneMatch, WallId
from hapticd_api.document import checked, merged
from hapticd_api.problem_response import problem_answers
from hapticd_api.wall_examples import PATCH_EXAMPLES, WALL_EXAMPLES

router = APIRouter(prefix="/api/v1/devices/{device_id}/scene/walls", tags=["walls"])

_READ_ERRORS = ("device-not-found", "wall-not-found")
_WRITE_ERRORS = (
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
_NOT_CHANGED: dict[int | str, dict[str, Any]] = {304: {"description": "The caller's copy still holds"}}


class ReadWall(Report):
    """A wall as it was written, and what it is granted at the present pose; null while it is off.

    `granted` may be sent back with the rest: it is not part of the wall, nor of what the `ETag` tags.
    """

    id: str
    shape: Shape
    law: Law
    friction: Friction | None
    enabled: bool
    fade_s: float
    granted: Granted | None


class WallList(Report):
    """The walls of a scene, in its order."""

    walls: list[ReadWall]


class WallResult(Report):
    """The outcome of an edit of one wall. `wall` is null once gone, `applied` while no loop has taken it."""

    wall: Wall | None
    stiffness_n_per_m: float | None = None
    granted: Granted | None = None
    etag: str
    revision: int
    applied: Applied | None
    dry_run: bool = False
    note: str | None = None


def _wall_result(result: SceneResult, wall_id: str) -> WallResult:
    granted = next((wall.granted for wall in result.walls if wall.id == wall_id), None)
    return WallResult(
        wall=result.scene.wall(wall_id),
        stiffness_n_per_m=granted.stiffness_n_per_m if granted else None,
        granted=granted,
        etag=result.etag,
        revision=result.revision,
        applied=result.applied,
        dry_run=result.dry_run,
        note=result.note,
    )


def _read(device: Device) -> list[ReadWall]:
    granted = {wall.id: wall.granted for wall in device.granted_walls(device.scene)}
    return [ReadWall(**dict(wall), granted=granted.get(wall.id)) for wall in device.scene.walls]


def _has(device: Device, wall_id: str) -> bool:
    return device.scene.wall(wall_id) is not None


@router.get(
    "",
    operation_id="list_walls",
    summary="All walls",
    response_model=WallList,
    responses={**problem_answers("device-not-found"), **_NOT_CHANGED},
)
async def list_walls(device: DeviceDep, if_none_match: IfNoneMatch = None) -> Response:
    """Every wall of the scene. The `ETag` is that of the scene."""
    return conditional(WallList(walls=_read(device)), device.scene_etag, if_none_match)


@router.post(
    "",
    operation_id="create_wall",
    summary="Make a wall",
    response_model=WallResult,
    status_code=201,
    responses=problem_answers(*_WRITE_ERRORS, "wall-exists"),
)
async def create_wall(
    device: DeviceDep,
    wall: Annotated[Wall, Body(openapi_examples=WALL_EXAMPLES)],
    terms: EditTerms,
) -> Response:
    """Adds a wall at the end of the scene; 409 if its id is taken. It fades in, also around the tool."""
    result = await device.put_wall(wall, terms, create_only=True)
    location = f"/api/v1/devices/{device.device_id}/scene/walls/{wall.id}"
    status = 200 if terms.dry_run else 201
    return tagged(_wall_result(result, wall.id), result.etag, status=status, location=location)


@router.get(
    "/{wall_id}",
    operation_id="get_wall",
    summary="One wall",
    response_model=ReadWall,
    responses={**problem_answers(*_READ_ERRORS), **_NOT_CHANGED},
)
async def get_wall(device: DeviceDep, wall_id: WallId, if_none_match: IfNoneMatch = None) -> Response:
    """The wall as it was written, ready to be edited and sent back, and what it is granted."""
    device.get_wall(wall_id)
    wall = next(wall for wall in _read(device) if wall.id == wall_id)
    return conditional(wall, device.scene_etag, if_none_match)


@router.put(
    "/{wall_id}",
    operation_id="put_wall",
    summary="Make or replace a wall",
    response_model=WallResult,
    responses={
        201: {"description": "The wall was made", "model": WallResult},
        **problem_answers(*_WRITE_ERRORS, "wall-exists"),
    },
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {
                "application/json": {
                    "schema": {"$ref": "#/components/schemas/Wall"},
                    "examples": WALL_EXAMPLES,
                }
            },
        }
    },
)
async def put_wall(
    device: DeviceDep,
    wall_id: WallId,
    document: Annotated[dict[str, Any], Body()],
    terms: EditTerms,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Makes the wall, or replaces it in its place. `id` may be left out: the address names it."""
    wall = checked(Wall, {"id": wall_id, **document})
    _check_name(wall, wall_id)
    is_new = not _has(device, wall_id)
    create_only = if_none_match is not None and if_none_match.strip() == "*"
    result = await device.put_wall(wall, terms, create_only=create_only)
    status = 201 if is_new and not terms.dry_run else 200
    return tagged(_wall_result(result, wall_id), result.etag, status=status)


@router.patch(
    "/{wall_id}",
    operation_id="patch_wall",
    summary="Change part of a wall",
    response_model=WallResult,
    responses=problem_answers(*_WRITE_ERRORS, "wall-not-found"),
)
async def patch_wall(
    device: DeviceDep,
    wall_id: WallId,
    patch: Annotated[dict[str, Any], Body(openapi_examples=PATCH_EXAMPLES)],
    terms: EditTerms,
) -> Response:
    """Merges a JSON merge patch (RFC 7396) into the wall; what it does not name stays.

    A shape or law whose `type` changes is replaced whole.
    """

    def change(before: Wall) -> Wall:
        wall = checked(Wall, merged(before.model_dump(mode="json"), patch))
        _check_name(wall, wall_id)
        return wall

    result = await device.change_wall(wall_id, change, terms)
    return tagged(_wall_result(result, wall_id), result.etag)


@router.delete(
    "/{wall_id}",
    operation_id="delete_wall",
    summary="Take a wall away",
    response_model=WallResult,
    responses=problem_answers(*_READ_ERRORS, "revision-stale", "storage-failed", "servo-silent"),
)
async def delete_wall(device: DeviceDep, wall_id: WallId, terms: EditTerms) -> Response:
    """Takes the wall out of the scene; its force fades out."""
    result = await device.delete_wall(wall_id, terms)
    return tagged(_wall_result(result, wall_id), result.etag)


def _check_name(wall: Wall, wall_id: str) -> None:
    if wall.id != wall_id:
        raise Problem(
            "invalid-document",
            f"The document's id is {wall.id!r}, its address says {wall_id!r}.",
            hint="Leave id out, or send the document to the address of that id.",
            pointer="/id",
        )
