"""Scenes and walls, from how people write them to how the loop takes them."""

from __future__ import annotations

import math
from functools import singledispatch
from typing import Any

from hapticd.flat_wall import NO_FRICTION, wall_key
from hapticd.laws import CubicDamper, Law
from hapticd.scene import Scene
from hapticd.shapes import SIZE_MAX_M, Box, Capsule, Plane, Sphere
from hapticd.vector import padded, unit
from hapticd.wall import Wall

COMMON = {"passivity", "brake"}
"""What the loop takes beside the law and not in it."""


def edit_fade_s(before: Scene, after: Scene) -> float:
    """Time of the cross-fade from one scene to another, s: the longest among the walls that differ.

    An edit that changes no wall but how all are rendered takes the longest of them all.
    """
    changed = set(before.walls) ^ set(after.walls)
    return max((wall.fade_s for wall in changed or after.walls), default=0.0)


def flatten(scene: Scene, revision: int, fade_s: float) -> tuple[dict[str, Any], list[str]]:
    """The scene as the loop takes it, and the ids of its walls in the loop's order.

    Only enabled walls are in it. Unit vectors are scaled here: a document may be off by rounding.
    """
    walls = [wall for wall in scene.walls if wall.enabled]
    flat = {
        "revision": revision,
        "fade_s": fade_s,
        "mapping": scene.mapping,
        "stiffness": scene.stiffness,
        "allocation": scene.allocation,
        "walls": [flatten_wall(wall) for wall in walls],
    }
    return flat, [wall.id for wall in walls]


def flatten_wall(wall: Wall) -> dict[str, Any]:
    """One wall as the loop takes it. Brakes may take part unless ``brake`` is false."""
    return {
        "key": wall_key(wall.id),
        "shape": flatten_shape(wall.shape),
        "law": _flat_law(wall.law),
        "passivity": wall.law.passivity,
        "brake": wall.law.brake is not False,
        "friction": dict(NO_FRICTION) if wall.friction is None else wall.friction.model_dump(),
    }


def _flat_law(law: Law) -> dict[str, Any]:
    flat = law.model_dump(exclude=COMMON)
    if isinstance(law, CubicDamper):
        flat["coefficient_n_s3_per_m3"] = law.coefficient
    return flat


@singledispatch
def flatten_shape(shape: object) -> dict[str, Any]:
    """A shape as the loop takes it: three coordinates wide. ``TypeError`` for what is no shape."""
    raise TypeError(f"{type(shape).__name__} is not a shape.")


@flatten_shape.register
def _flat_plane(plane: Plane) -> dict[str, Any]:
    normal = unit(plane.normal)
    offset_m = sum(n * p for n, p in zip(normal, plane.point_m, strict=True))
    return {"type": "plane", "normal": padded(normal), "offset_m": offset_m}


@flatten_shape.register
def _flat_sphere(sphere: Sphere) -> dict[str, Any]:
    return {
        "type": "sphere",
        "center_m": padded(sphere.center_m),
        "radius_m": sphere.radius_m,
        "hollow": sphere.hollow,
    }


@flatten_shape.register
def _flat_box(box: Box) -> dict[str, Any]:
    # A rectangle reaches as far across its plane as any wall.
    edges_m = (*box.size_m, *[2 * SIZE_MAX_M] * (3 - len(box.size_m)))
    return {
        "type": "box",
        "center_m": padded(box.center_m),
        "axes": _turned(box),
        "half_m": [edge_m / 2 for edge_m in edges_m],
        "hollow": box.hollow,
    }


@flatten_shape.register
def _flat_capsule(capsule: Capsule) -> dict[str, Any]:
    return {
        "type": "capsule",
        "from_m": padded(capsule.from_m),
        "to_m": padded(capsule.to_m),
        "radius_m": capsule.radius_m,
        "hollow": capsule.hollow,
    }


def _turned(box: Box) -> list[list[float]]:
    """Unit vectors of a box's edges: the columns of its rotation matrix."""
    if box.angle_rad is not None:
        half_rad = box.angle_rad / 2
        return _columns((math.cos(half_rad), 0.0, 0.0, math.sin(half_rad)))
    return _columns(box.orientation or (1.0, 0.0, 0.0, 0.0))


def _columns(quaternion: tuple[float, ...]) -> list[list[float]]:
    w, x, y, z = unit(quaternion)
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ]
