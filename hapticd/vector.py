"""Vectors of documents: two or three coordinates, as the device has them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated

from pydantic import Field, Strict

from hapticd.problem import Problem

AXES = 3
"""Width of the loop's vectors; a two-dimensional device pads with zeros."""

COORDINATE_MAX_M = 10.0
"""Largest coordinate of a point: past it, millimetres were meant."""

UNIT_TOLERANCE = 1e-3
"""How far a vector of unit length may be off by rounding."""

Coordinate = Annotated[float, Field(ge=-COORDINATE_MAX_M, le=COORDINATE_MAX_M)]
Point = Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=AXES), Strict(False)]
Component = Annotated[float, Field(ge=-2, le=2)]
Direction = Annotated[tuple[Component, ...], Field(min_length=2, max_length=AXES), Strict(False)]


def unit_vector(vector: tuple[float, ...]) -> tuple[float, ...]:
    """``vector`` itself when it is of unit length within ``UNIT_TOLERANCE``; ``ValueError`` otherwise."""
    length = math.hypot(*vector)
    if length == 0.0:
        example = [0] * (len(vector) - 1) + [1]
        raise ValueError(f"The vector is zero and so has no direction; write for example {example}.")
    if abs(length - 1.0) > UNIT_TOLERANCE:
        unit = [round(component / length, 6) for component in vector]
        raise ValueError(f"The vector has length {length:.6g}, it must be 1; write {unit}.")
    return vector


def unit(vector: Sequence[float]) -> list[float]:
    """``vector``, scaled to unit length."""
    length = math.hypot(*vector)
    return [component / length for component in vector]


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
