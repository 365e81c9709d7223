"""What walls are made of, as people write it: metres in the base frame, as many coordinates as the device."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, Strict, ValidationInfo, field_validator, model_validator

from hapticd.document import Document
from hapticd.vector import AXES, Component, Direction, Point, unit_vector

SIZE_MIN_M = 1e-4
"""Smallest size: below it the wall is thinner than what the encoders tell apart."""

SIZE_MAX_M = 10.0
"""Largest size: past it, millimetres were meant."""

Size = Annotated[float, Field(ge=SIZE_MIN_M, le=SIZE_MAX_M)]
Sizes = Annotated[tuple[Size, ...], Field(min_length=2, max_length=AXES), Strict(False)]
Quaternion = Annotated[tuple[Component, ...], Field(min_length=4, max_length=4), Strict(False)]
Hollow = Annotated[bool, Field(description="A thin shell, felt from the side on which the tip is")]


class Plane(Document):
    """A half-space: solid behind the plane, free where ``normal`` points."""

    type: Literal["plane"]
    point_m: Point = Field(description="A point of the plane, m", examples=[[0, 0, -0.02]])
    normal: Direction = Field(description="Unit normal, pointing into free space", examples=[[0, 0, 1]])

    _normal = field_validator("normal")(unit_vector)

    @model_validator(mode="after")
    def _one_dimension(self) -> Self:
        if len(self.point_m) != len(self.normal):
            raise ValueError(
                f"point_m has {len(self.point_m)} coordinates, normal {len(self.normal)}; they must agree."
            )
        return self


class Sphere(Document):
    """A ball; on a two-dimensional device a disc."""

    type: Literal["sphere"]
    center_m: Point = Field(description="Its centre, m", examples=[[0.2, 0, 0]])
    radius_m: Size = Field(description="Its radius, m", examples=[0.03])
    hollow: Hollow = False


class Box(Document):
    """A cuboid; on a two-dimensional device a rectangle.

    It is turned about its centre by ``orientation``, a unit quaternion (w, x, y, z), or by ``angle_rad`` in
    the plane; unturned its edges lie along the axes of the base frame.
    """

    type: Literal["box"]
    center_m: Point = Field(description="Its centre, m", examples=[[0.2, 0, -0.03]])
    size_m: Sizes = Field(description="Its edges, m", examples=[[0.1, 0.1, 0.02]])
    orientation: Quaternion | None = Field(
        None, description="Three dimensions: how it is turned, w, x, y, z", examples=[[1, 0, 0, 0]]
    )
    angle_rad: Annotated[float, Field(ge=-6.3, le=6.3)] | None = Field(
        None, description="Two dimensions: how far it is turned to the left, rad"
    )
    hollow: Hollow = False

    @field_validator("size_m")
    @classmethod
    def _one_dimension(cls, size_m: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
        dimensions = len(info.data.get("center_m", size_m))
        if len(size_m) != dimensions:
            raise ValueError(
                f"It has {len(size_m)} edges, center_m {dimensions} coordinates: as many of both."
            )
        return size_m

    @field_validator("orientation")
    @classmethod
    def _in_space(cls, orientation: Quaternion | None, info: ValidationInfo) -> Quaternion | None:
        if orientation is None:
            return None
        if len(info.data.get("center_m", ())) == 2:
            raise ValueError("A box with two coordinates is turned by angle_rad; write that instead.")
        return unit_vector(orientation)

    @field_validator("angle_rad")
    @classmethod
    def _in_the_plane(cls, angle_rad: float | None, info: ValidationInfo) -> float | None:
        if angle_rad is not None and len(info.data.get("center_m", ())) == AXES:
            raise ValueError("A box with three coordinates is turned by orientation; write that instead.")
        return angle_rad


class Capsule(Document):
    """Everything within a radius of a segment; on a two-dimensional device a stadium."""

    type: Literal["capsule"]
    from_m: Point = Field(description="One end of the segment, m", examples=[[0.2, -0.05, 0]])
    to_m: Point = Field(description="Its other end, m", examples=[[0.2, 0.05, 0]])
    radius_m: Size = Field(description="The radius about it, m", examples=[0.01])
    hollow: Hollow = False

    @field_validator("to_m")
    @classmethod
    def _another_end(cls, to_m: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
        from_m = info.data.get("from_m", ())
        if from_m and len(to_m) != len(from_m):
            raise ValueError(f"It has {len(to_m)} coordinates, from_m {len(from_m)}; they must agree.")
        if to_m == from_m:
            raise ValueError("Both ends are one point; write a sphere instead.")
        return to_m


Shape = Annotated[Plane | Sphere | Box | Capsule, Field(discriminator="type")]

VECTORS = ("point_m", "center_m", "from_m")
"""The vector of each shape whose length tells its dimension; the shape's others agree with it."""
