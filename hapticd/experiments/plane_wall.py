"""Flat walls with a motion law, as the core takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def plane_wall(normal: Vector, offset_m: float, eta: float = 0.0, *, key: int = 1) -> dict[str, Any]:
    """The half-space n·x ≤ ``offset_m`` is the wall; its set-point gives in by ``eta`` of the depth."""
    return {
        "key": key,
        "shape": {"type": "plane", "normal": normal.tolist(), "offset_m": offset_m},
        "law": {"type": "motion", "eta": eta},
    }


def pinned(point: Vector, normals: NDArray[np.float64], eta: float = 0.0) -> list[dict[str, Any]]:
    """Pairs of walls back to back at ``point``: along each of ``normals`` the set-point stays there.

    Two half-spaces that share their surface leave no free side, so that the coupling works both ways.
    """
    sides = np.concatenate([normals, -normals])
    return [plane_wall(n, float(n @ point), eta, key=1 + i) for i, n in enumerate(sides)]
