"""The scene: the ordered set of walls a device renders, as people write it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Strict, field_validator

from hapticd.document import Document
from hapticd.problem import Problem
from hapticd.wall import Wall, check_brakes, check_wall

MAX_WALLS = 256
"""Most walls one scene holds; the loop's arrays have this size."""


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


def check_scene(scene: Scene, dof: int, *, brakes: bool = True) -> None:
    """Refuses a scene that does not fit a device of ``dof`` coordinates, with ``brakes`` or without.

    Raises ``Problem``.
    """
    for index, wall in enumerate(scene.walls):
        check_wall(wall, dof, inside=f"/walls/{index}")
        if not brakes:
            check_brakes(wall, inside=f"/walls/{index}")
