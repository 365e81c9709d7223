"""What an edit of a scene came to, and what each of its walls was granted."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hapticd.analysis.stability import StabilityBudget
from hapticd.scene import Scene
from hapticd.snapshot import Applied, Report


class Granted(Report):
    """What a wall comes to at the present pose, and why. Null is what cannot be said.

    ``stiffness_fraction`` is its share of what the device gives a rigid wall at this pose. ``brake`` is
    whether brakes take part in it, ``friction_actuator`` what renders its friction, ``forced`` whether it was
    let in over its stability budget. ``budget`` is there when the edit had to be let in.
    """

    stiffness_n_per_m: float | None = None
    stiffness_fraction: float | None = None
    damping_n_s_per_m: float | None = None
    brake: bool = False
    passivity: bool = False
    friction_actuator: Literal["motor", "brake"] | None = None
    forced: bool = False
    why: list[str] = Field(default_factory=list)
    budget: StabilityBudget | None = None


class GrantedWall(Report):
    """What one wall of a scene was granted; ``stiffness_n_per_m`` is the one in ``granted``."""

    id: str
    stiffness_n_per_m: float | None
    granted: Granted


class SceneResult(Report):
    """The outcome of an edit. ``applied`` is null when nothing reached a loop; ``note`` says why."""

    scene: Scene
    etag: str
    revision: int
    applied: Applied | None
    dry_run: bool = False
    note: str | None = None
    walls: list[GrantedWall] = Field(default_factory=list)
