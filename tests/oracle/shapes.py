"""Closest points of balls, boxes and capsules, by candidates instead of half-spaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Point = NDArray[np.float64]


@dataclass(frozen=True)
class Ball:
    center_m: Point
    radius_m: float

    def flat(self, hollow: bool) -> dict[str, Any]:
        """As the loop takes it."""
        center = self.center_m.tolist()
        return {"type": "sphere", "center_m": center, "radius_m": self.radius_m, "hollow": hollow}

    def surface(self, x: Point) -> Point:
        """The point of the surface closest to x."""
        away = x - self.center_m
        return self.center_m + self.radius_m * away / np.linalg.norm(away)


@dataclass(frozen=True)
class Capsule:
    from_m: Point
    to_m: Point
    radius_m: float

    def flat(self, hollow: bool) -> dict[str, Any]:
        """As the loop takes it."""
        ends = {"from_m": self.from_m.tolist(), "to_m": self.to_m.tolist()}
        return {"type": "capsule", **ends, "radius_m": self.radius_m, "hollow": hollow}

    def surface(self, x: Point) -> Point:
        """The point of the surface closest to x: of the foot on the line, or of one of the ends."""
        along = self.to_m - self.from_m
        foot = self.from_m + along * ((x - self.from_m) @ along) / (along @ along)
        feet = [self.from_m, self.to_m]
        if (foot - self.from_m) @ (foot - self.to_m) <= 0.0:
            feet.append(foot)
        axis = min(feet, key=lambda candidate: float(np.linalg.norm(x - candidate)))
        return axis + self.radius_m * (x - axis) / np.linalg.norm(x - axis)


@dataclass(frozen=True)
class Box:
    center_m: Point
    axes: Point
    half_m: Point

    def flat(self, hollow: bool) -> dict[str, Any]:
        """As the loop takes it."""
        frame = {"axes": self.axes.tolist(), "half_m": self.half_m.tolist()}
        return {"type": "box", "center_m": self.center_m.tolist(), **frame, "hollow": hollow}

    def surface(self, x: Point) -> Point:
        """The point of the surface closest to x: the best of the closest points of its six faces."""
        local = self.axes @ (x - self.center_m)
        faces = []
        for axis in range(3):
            for sign in (-1.0, 1.0):
                face = np.clip(local, -self.half_m, self.half_m)
                face[axis] = sign * self.half_m[axis]
                faces.append(face)
        best = min(faces, key=lambda face: float(np.linalg.norm(face - local)))
        return self.center_m + self.axes.T @ best


Shape = Ball | Capsule | Box


def random_shape(rng: np.random.Generator, kind: type[Shape]) -> Shape:
    """A shape of some centimetres around the origin, anyhow turned."""
    center, size = rng.uniform(-0.05, 0.05, 3), rng.uniform(0.01, 0.04, 3)
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if kind is Ball:
        return Ball(center, size[0])
    if kind is Capsule:
        return Capsule(center, center + size[0] * axes[0], size[1])
    return Box(center, axes, size)


def inner_point(rng: np.random.Generator, shape: Shape) -> Point:
    """Anywhere inside, though never where no surface point is closest."""
    if isinstance(shape, Box):
        return shape.center_m + shape.axes.T @ (shape.half_m * rng.uniform(-0.95, 0.95, 3))
    start = (
        shape.center_m
        if isinstance(shape, Ball)
        else shape.from_m + rng.uniform() * (shape.to_m - shape.from_m)
    )
    direction = rng.normal(size=3)
    return start + shape.radius_m * rng.uniform(0.3, 0.95) * direction / np.linalg.norm(direction)
