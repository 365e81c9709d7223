"""Documents that tests send."""

from __future__ import annotations

from typing import Any


def floor(**changes: Any) -> dict[str, Any]:
    """A rigid floor for a device with three coordinates."""
    return {
        "id": "floor",
        "shape": {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]},
        "law": {"type": "motion", "eta": 0.0},
        **changes,
    }
