"""A wall, as people write it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import Field, model_validator

from hapticd.document import Document, Identifier
from hapticd.friction import Friction
from hapticd.laws import Law
from hapticd.problem import Problem
from hapticd.shapes import VECTORS, Shape
from hapticd.vector import check_length

FADE_MAX_S = 5.0

GRANTED = "granted"
"""What a reader is told beside the wall; it may be sent back and is not part of it."""


class Wall(Document):
    """One wall: a shape, how it answers penetration, and maybe friction."""

    id: Identifier = Field(examples=["floor"])
    shape: Shape
    law: Law
    friction: Friction | None = Field(None, description="Friction on its surface; null is none")
    enabled: bool = True
    fade_s: float = Field(0.2, ge=0.0, le=FADE_MAX_S, description="Time over which a change takes effect, s")

    @model_validator(mode="before")
    @classmethod
    def _without_granted(cls, document: Any) -> Any:
        if isinstance(document, Mapping):
            return {name: value for name, value in document.items() if name != GRANTED}
        return document


def check_wall(wall: Wall, dof: int, *, inside: str = "") -> None:
    """Refuses a wall whose vectors do not fit a device of ``dof`` coordinates.

    ``inside`` is the JSON pointer of the wall in the document. Raises ``Problem``.
    """
    shape = wall.shape.model_dump()
    for name in VECTORS:
        if name in shape:
            check_length(shape[name], dof, f"{inside}/shape/{name}")


def check_brakes(wall: Wall, *, inside: str = "") -> None:
    """Refuses a wall that asks for brakes, for a device without. Raises ``Problem``."""
    if wall.law.brake:
        raise _no_brakes(f"{inside}/law/brake", "Write null, or leave it out: motors render the wall.")
    if wall.friction is not None and wall.friction.actuator == "brake":
        raise _no_brakes(f"{inside}/friction/actuator", "Write auto or motor.")


def _no_brakes(pointer: str, hint: str) -> Problem:
    detail = f"{pointer} asks for brakes, this device has none."
    return Problem("no-brakes", detail, hint=hint, pointer=pointer)
