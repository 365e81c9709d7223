"""Walls as the loop takes them: plain numbers, three coordinates wide."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

NO_FRICTION: Mapping[str, Any] = {"static": 0.0, "kinetic": 0.0, "actuator": "auto"}


def wall_key(wall_id: str) -> int:
    """The loop's number for a wall's id: the same wall keeps it through edits, restarts and renumbering."""
    return int.from_bytes(hashlib.blake2b(wall_id.encode(), digest_size=8).digest(), "little")


def flat_plane(
    normal: Sequence[float],
    offset_m: float,
    law: Mapping[str, Any],
    *,
    key: int = 1,
    passivity: bool = False,
    brake: bool = True,
    friction: Mapping[str, Any] = NO_FRICTION,
) -> dict[str, Any]:
    """A half-space: free is n·x ≥ ``offset_m``, m, with ``normal`` of unit length and shape (3,).

    ``law`` is for example ``{"type": "motion", "eta": 0.0}``.
    """
    return {
        "key": key,
        "shape": {"type": "plane", "normal": list(normal), "offset_m": offset_m},
        "law": dict(law),
        "passivity": passivity,
        "brake": brake,
        "friction": dict(friction),
    }


def rigid_plane(
    normal: Sequence[float], offset_m: float, *, eta: float = 0.0, key: int = 1
) -> dict[str, Any]:
    """A half-space with the motion law (WN eq. 30); η = 0 is rigid."""
    return flat_plane(normal, offset_m, {"type": "motion", "eta": eta}, key=key)
