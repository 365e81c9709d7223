"""The scene: the ordered set of walls a device renders, as people write it.

Shapes and laws carry a ``type``, so that further ones become members of a union without changing these.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, Strict, field_validator, model_validator

from hapticd.flat_wall import rigid_plane, wall_key
from hapticd.problem import Problem

MAX_WALLS = 256
"""Most walls one scene holds; the loop's arrays have this size."""

AXES = 3
"""Width of the loop's vectors; a two-dimensional device pads with zeros."""

COORDINATE_MAX_M = 10.0
"""Largest coordinate of a point: past it, millimetres were meant."""

FADE_MAX_S = 5.0
NORMAL_TOLERANCE = 1e-3

Identifier = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_.-]{0,62}$")]
Coordinate = Annotated[float, Field(ge=-COORDINATE_MAX_M, le=COORDINATE_MAX_M)]
Point = Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=AXES), Strict(False)]
Direction = Annotated[
    tuple[Annotated[float, Field(ge=-2, le=2)], ...], Field(min_length=2, max_length=AXES), Strict(False)
]


class Document(BaseModel):
    """What people write: unknown fields and values that are not finite are refused, nothing is coerced."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def unit_vector(vector: tuple[float, ...]) -> tuple[float, ...]:
    """``vector`` itself when it is of unit length within ``NORMAL_TOLERANCE``; ``ValueError`` otherwise."""
    length = math.hypot(*vector)
    if length == 0.0:
        raise ValueError("The vector is zero and so has no direction; write for example [0, 0, 1].")
    if abs(length - 1.0) > NORMAL_TOLERANCE:
        unit = [round(component / length, 6) for component in vector]
        raise ValueError(f"The vector has length {length:.6g}, it must be 1; write {unit}.")
    return vector


class Plane(Document):
    """A half-space: solid behind the plane, free where ``normal`` points."""

    type: Literal["plane"]
    point_m: Point = Field(description="A point of the plane in the base frame, m", examples=[[0, 0, -0.02]])
    normal: Direction = Field(description="Unit normal, pointing into free space", examples=[[0, 0, 1]])

    _normal = field_validator("normal")(unit_vector)

    @model_validator(mode="after")
    def _one_dimension(self) -> Self:
        if len(self.point_m) != len(self.normal):
            raise ValueError(
                f"point_m has {len(self.point_m)} coordinates, normal {len(self.normal)}; they must agree."
            )
        return self


class MotionLaw(Document):
    """Motion law (WN eq. 17, 30): the tip's set-point penetrates by η times the depth of the hand."""

    type: Literal["motion"]
    eta: float = Field(ge=0.0, le=1.0, description="0 is rigid, 1 is free")


class Wall(Document):
    """One wall."""

    id: Identifier = Field(examples=["floor"])
    shape: Plane
    law: MotionLaw
    enabled: bool = True
    fade_s: float = Field(0.2, ge=0.0, le=FADE_MAX_S, description="Time over which a change takes effect, s")


class Scene(Document):
    """Everything one device renders."""

    mapping: Literal["transpose", "inverse"] = Field(
        "transpose", description="Joint mapping: transpose is isotropic (WN eq. 23, 24), inverse is WN eq. 18"
    )
    stiffness: Literal["pose", "workspace"] = Field(
        "pose",
        description="k_c: the largest bound of the present pose, or one constant for the whole workspace",
    )
    allocation: Literal["motor_only", "motor_and_brake", "brake_only"] = Field(
        "motor_and_brake",
        description="Which actuators share the torque; without brakes the motors take it all",
    )
    walls: Annotated[tuple[Wall, ...], Field(max_length=MAX_WALLS), Strict(False)] = ()
    note: Annotated[str, Field(max_length=500)] | None = None

    @field_validator("walls")
    @classmethod
    def _unique_ids(cls, walls: tuple[Wall, ...]) -> tuple[Wall, ...]:
        seen: set[str] = set()
        for wall in walls:
            if wall.id in seen:
                raise ValueError(f"Two walls have the id {wall.id!r}; ids must be unique.")
            seen.add(wall.id)
        return walls

    def wall(self, wall_id: str) -> Wall | None:
        """The wall with this id, or none."""
        return next((wall for wall in self.walls if wall.id == wall_id), None)

    def with_wall(self, wall: Wall) -> Scene:
        """The scene with ``wall`` in the place of its namesake, or at the end."""
        if self.wall(wall.id) is None:
            return self.with_walls((*self.walls, wall))
        return self.with_walls(tuple(wall if old.id == wall.id else old for old in self.walls))

    def without_wall(self, wall_id: str) -> Scene:
        """The scene without the wall of this id."""
        return self.with_walls(tuple(wall for wall in self.walls if wall.id != wall_id))

    def with_walls(self, walls: tuple[Wall, ...]) -> Scene:
        """The scene with other walls. ``Problem`` when there are too many."""
        if len(walls) > MAX_WALLS:
            raise Problem(
                "too-many-walls",
                f"The scene would have {len(walls)} walls, {MAX_WALLS} is the most.",
                pointer="/walls",
            )
        return self.model_copy(update={"walls": walls})


def check_wall(wall: Wall, dof: int, *, inside: str = "") -> None:
    """Refuses a wall whose vectors do not fit a device of ``dof`` coordinates.

    ``inside`` is the JSON pointer of the wall in the document. Raises ``Problem``.
    """
    check_length(wall.shape.point_m, dof, f"{inside}/shape/point_m")


def check_scene(scene: Scene, dof: int) -> None:
    """Refuses a scene that does not fit a device of ``dof`` coordinates. Raises ``Problem``."""
    for index, wall in enumerate(scene.walls):
        check_wall(wall, dof, inside=f"/walls/{index}")


def check_length(vector: Sequence[float], dof: int, pointer: str) -> None:
    """Refuses a vector that has not ``dof`` components. Raises ``Problem``."""
    if len(vector) != dof:
        raise Problem(
            "dimension-mismatch",
            f"{pointer} has {len(vector)} components, this device has {dof} coordinates.",
            pointer=pointer,
        )


def padded(vector: Sequence[float]) -> list[float]:
    """``vector`` as the loop takes it: ``AXES`` wide, zeros at the end."""
    return [*vector, *[0.0] * (AXES - len(vector))]


def edit_fade_s(before: Scene, after: Scene) -> float:
    """Time of the cross-fade from one scene to another, s: the longest among the walls that differ.

    An edit that changes no wall but how all are rendered takes the longest of them all.
    """
    changed = set(before.walls) ^ set(after.walls)
    return max((wall.fade_s for wall in changed or after.walls), default=0.0)


def flatten(scene: Scene, revision: int, fade_s: float) -> tuple[dict[str, Any], list[str]]:
    """The scene as the loop takes it, and the ids of its walls in the loop's order.

    Only enabled walls are in it. Normals are scaled to unit length here: a document may be off by rounding.
    """
    walls = [wall for wall in scene.walls if wall.enabled]
    flat = {
        "revision": revision,
        "fade_s": fade_s,
        "mapping": scene.mapping,
        "stiffness": scene.stiffness,
        "allocation": scene.allocation,
        "walls": [_flat_wall(wall) for wall in walls],
    }
    return flat, [wall.id for wall in walls]


def _flat_wall(wall: Wall) -> dict[str, Any]:
    length = math.hypot(*wall.shape.normal)
    normal = [component / length for component in wall.shape.normal]
    offset_m = sum(n * p for n, p in zip(normal, wall.shape.point_m, strict=True))
    return rigid_plane(padded(normal), offset_m, eta=wall.law.eta, key=wall_key(wall.id))
