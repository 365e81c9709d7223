"""Walls as examples of the API: every shape and every law once."""

from __future__ import annotations

from typing import Any

_PLANE = {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]}
_RIGID = {"type": "motion", "eta": 0.0}


def _example(
    summary: str, wall_id: str, shape: dict[str, Any], law: dict[str, Any], **more: Any
) -> dict[str, Any]:
    return {"summary": summary, "value": {"id": wall_id, "shape": shape, "law": law, **more}}


WALL_EXAMPLES: dict[str, Any] = {
    "floor": _example("A rigid floor 2 cm below the origin", "floor", _PLANE, _RIGID, fade_s=0.2),
    "spring": _example(
        "A floor of 800 N/m, watched by passivity control",
        "floor",
        _PLANE,
        {"type": "spring", "stiffness_n_per_m": 800, "damping_n_s_per_m": 2, "passivity": True},
    ),
    "damper": _example("A floor like honey", "honey", _PLANE, {"type": "damper", "damping_n_s_per_m": 10}),
    "cubic_damper": _example(
        "A wall on a device with two coordinates: the faster, the harder",
        "wall",
        {"type": "plane", "point_m": [0, 0.18], "normal": [0, 1]},
        {"type": "cubic_damper", "form": "implicit", "brake": True},
    ),
    "friction": _example("A rough floor", "floor", _PLANE, _RIGID, friction={"static": 0.4, "kinetic": 0.3}),
    "sphere": _example(
        "A ball", "ball", {"type": "sphere", "center_m": [0.2, 0, -0.03], "radius_m": 0.02}, _RIGID
    ),
    "box": _example(
        "A room the tip does not leave, turned by 90° about z",
        "room",
        {
            "type": "box",
            "center_m": [0.2, 0, 0.02],
            "size_m": [0.1, 0.08, 0.06],
            "orientation": [0.7071, 0, 0, 0.7071],
            "hollow": True,
        },
        _RIGID,
    ),
    "rectangle": _example(
        "A turned rectangle on a device with two coordinates",
        "block",
        {"type": "box", "center_m": [0, 0.15], "size_m": [0.1, 0.04], "angle_rad": 0.3},
        _RIGID,
    ),
    "capsule": _example(
        "A rod",
        "rod",
        {"type": "capsule", "from_m": [0.2, -0.05, -0.02], "to_m": [0.2, 0.05, -0.02], "radius_m": 0.01},
        _RIGID,
    ),
}

PATCH_EXAMPLES: dict[str, Any] = {
    "softer": {"summary": "Half as stiff", "value": {"law": {"eta": 0.5}}},
    "off": {"summary": "Out of the way, but kept", "value": {"enabled": False}},
    "spring": {
        "summary": "Another law: a law whose type changes is replaced whole",
        "value": {"law": {"type": "spring", "stiffness_n_per_m": 800}},
    },
    "smooth": {"summary": "Without friction", "value": {"friction": None}},
}
