"""Walls in words, short enough for a line of a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hapticd_client.documents import Granted
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


def granted_in_words(granted: Granted | None) -> str:
    """What is worth telling of a grant: stiffness, and why it is less than was asked for."""
    if granted is None or not granted["stiffness_n_per_m"]:
        return ""
    told = f"; {granted['stiffness_n_per_m']:.0f} N/m at this pose"
    if granted["forced"] or (granted["stiffness_fraction"] or 1.0) < 1.0:
        told += f" ({granted['why'][-1 if granted['forced'] else 0].rstrip('.')})"
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
