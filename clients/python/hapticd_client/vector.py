"""Vectors on the command line: ``0,0,-0.02``."""

from __future__ import annotations

import math

import typer


class Vector(tuple[float, ...]):
    """Two or three finite numbers, written with commas."""

    @classmethod
    def parse(cls, text: str) -> Vector:
        """The vector that ``text`` spells. Raises ``typer.BadParameter``."""
        try:
            vector = cls(float(part) for part in text.split(","))
        except ValueError:
            raise typer.BadParameter(f"{text!r} is not a vector; write it as 0,0,1.") from None
        if len(vector) not in (2, 3) or not all(map(math.isfinite, vector)):
            raise typer.BadParameter(f"{text!r} must be two or three finite numbers, such as 0,0,1.")
        return vector
