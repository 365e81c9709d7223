"""The operator's hand of a twin: what it is told to do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, Strict, TypeAdapter, field_validator

from hapticd.document import Document
from hapticd.vector import AXES, Point, check_length, padded

Line = Annotated[
    tuple[Annotated[float, Field(ge=-1e3, le=1e3)], ...], Field(min_length=2, max_length=AXES), Strict(False)
]
"""A direction of any length but zero."""

FORCE_MAX_N = 200.0


def with_length(vector: tuple[float, ...]) -> tuple[float, ...]:
    """``vector`` itself, unless it is zero: then ``ValueError``."""
    if math.hypot(*vector) < 1e-9:
        raise ValueError("The vector is zero and so has no direction; write for example [0, 0, -1].")
    return vector


class Free(Document):
    """The hand is off the device."""

    type: Literal["free"]


class Hold(Document):
    """The hand stays where it is."""

    type: Literal["hold"]
    stiff: bool = Field(False, description="The arm is braced")


class Follow(Document):
    """The hand goes smoothly to a point, and follows it when it is moved."""

    type: Literal["follow"]
    target_m: Point


class Push(Document):
    """The hand advances along a line until it pushes with a force."""

    type: Literal["push"]
    direction: Line
    force_n: float = Field(ge=0.0, le=FORCE_MAX_N)
    speed_m_per_s: float = Field(0.1, gt=0.0, le=2.0)

    _direction = field_validator("direction")(with_length)


class Stroke(Document):
    """The hand swings sinusoidally about a point."""

    type: Literal["stroke"]
    center_m: Point
    axis: Line
    amplitude_m: float = Field(ge=0.0, le=0.5)
    frequency_hz: float = Field(ge=0.0, le=20.0)

    _axis = field_validator("axis")(with_length)


class MinimumJerk(Document):
    """The hand goes to one point and leaves it for another on a minimum-jerk path."""

    type: Literal["minimum_jerk"]
    from_m: Point
    to_m: Point
    duration_s: float = Field(gt=0.0, le=60.0)


class Clamp(Document):
    """No hand: a bench clamp holds the tip at a point, stiff to the ground."""

    type: Literal["clamp"]
    position_m: Point


def _follow_by_default(document: object) -> object:
    """``{"target_m": […]}`` alone is a point to follow."""
    if isinstance(document, Mapping) and "type" not in document and "target_m" in document:
        return {"type": "follow", **document}
    return document


HandScript = Annotated[
    Annotated[Free | Hold | Follow | Push | Stroke | MinimumJerk | Clamp, Field(discriminator="type")],
    BeforeValidator(_follow_by_default),
]
"""What the hand does. The member ``type`` may be left out of ``{"type": "follow", "target_m": […]}``."""

HAND_SCRIPT: TypeAdapter[HandScript] = TypeAdapter(HandScript)

VECTORS = frozenset({"target_m", "direction", "center_m", "axis", "from_m", "to_m", "position_m"})


def flat_script(script: HandScript, dof: int) -> dict[str, Any]:
    """The script as the loop takes it, vectors padded. ``Problem`` when a vector is not ``dof`` long."""
    flat = script.model_dump()
    for name in VECTORS & flat.keys():
        check_length(flat[name], dof, f"/{name}")
        flat[name] = padded(flat[name])
    return flat
