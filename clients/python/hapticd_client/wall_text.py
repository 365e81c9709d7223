"""Walls in words, short enough for a line of a table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from hapticd_client.documents import WallResult
from hapticd_client.walls import Wall

UNITS = {
    "_n_s3_per_m3": "N·s³/m³",
    "_n_s_per_m": "N·s/m",
    "_n_per_m": "N/m",
    "_rad": "rad",
    "_m": "m",
}
"""Units by the ends of the fields' names, longest first."""


def shape_in_words(wall: Wall) -> str:
    """Such as ``sphere center 0.2, 0, 0, radius 0.02 m, hollow``."""
    return _in_words(wall["shape"])


def law_in_words(wall: Wall) -> str:
    """Such as ``spring stiffness 800 N/m, passivity``."""
    return _in_words(wall["law"])


def friction_in_words(wall: Wall) -> str:
    """Such as ``0.4 / 0.3``; a dash without friction."""
    friction = wall.get("friction")
    return f"{friction['static']:g} / {friction['kinetic']:g}" if friction else "–"


def granted_in_words(result: WallResult) -> str:
    """What is worth telling of a grant: its stiffness, and why it is not what was asked for."""
    wall, granted = result["wall"], result["granted"]
    if wall is None or granted is None:
        return ""
    stiffness_n_per_m = granted["stiffness_n_per_m"]
    told = f"; {stiffness_n_per_m:.0f} N/m at this pose" if stiffness_n_per_m else ""
    law = wall["law"]
    if granted["forced"]:
        told += f" ({granted['why'][-1]})"
    elif law["type"] == "spring" and law["stiffness_n_per_m"] > (stiffness_n_per_m or math.inf):
        told += f" ({granted['why'][0]})"
    return told


def _in_words(document: Mapping[str, Any]) -> str:
    fields = [_field(name, value) for name, value in document.items() if name != "type"]
    return " ".join([document["type"], ", ".join(field for field in fields if field)]).strip()


def _field(name: str, value: object) -> str:
    if value is None or value is False:
        return ""
    if value is True:
        return name
    label, unit = next(
        ((name.removesuffix(end), unit) for end, unit in UNITS.items() if name.endswith(end)), (name, "")
    )
    if isinstance(value, list | tuple):
        return f"{label} {', '.join(f'{part:g}' for part in value)}"
    told = f"{value:g}" if isinstance(value, int | float) else str(value)
    return f"{label} {told} {unit}".rstrip()
