"""Which walls of an edit are to be let in, and the scene that comes of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from hapticd.admission import Admission, admit
from hapticd.analysis.device_stability import DeviceStability
from hapticd.scene import Scene
from hapticd.wall import Wall


@dataclass(frozen=True)
class AdmittedScene:
    """A scene whose walls are let in, and the admissions of those that were looked at, by id."""

    scene: Scene
    admissions: Mapping[str, Admission]


def admit_scene(
    stability: DeviceStability, before: Scene, after: Scene, *, force: bool, about: str | None = None
) -> AdmittedScene:
    """Lets in what an edit adds, changes or switches on; what renders already is not asked again.

    A wall let in by ``force`` gets passivity. ``about`` is the id of the wall that is the caller's whole
    document, for JSON pointers into it. Some milliseconds a law. ``Problem``: over-stability-budget.
    """
    admissions: dict[str, Admission] = {}
    scene = after
    for index, wall in _asked(before, after):
        inside = "" if wall.id == about else f"/walls/{index}"
        admission = admit(stability, wall.law, force=force, pointer=f"{inside}/law")
        admissions[wall.id] = admission
        if admission.passivity != wall.law.passivity:
            scene = scene.with_wall(_watched(wall))
    return AdmittedScene(scene, admissions)


def _asked(before: Scene, after: Scene) -> Iterator[tuple[int, Wall]]:
    for index, wall in enumerate(after.walls):
        old = before.wall(wall.id)
        rendered = old is not None and old.enabled and old.law == wall.law
        if wall.enabled and not rendered:
            yield index, wall


def _watched(wall: Wall) -> Wall:
    return wall.model_copy(update={"law": wall.law.model_copy(update={"passivity": True})})
