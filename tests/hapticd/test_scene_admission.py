"""Edits are let in only within the stability budget; what renders already is not asked again."""

from typing import Any

import pytest

from hapticd.analysis.device_stability import DeviceStability
from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.model import load_model
from hapticd.problem import Problem
from hapticd.scene import Scene
from hapticd.scene_admission import admit_scene
from tests.hapticd.conftest import make_wall

# Ten ticks of delay: no twin comes to rest at the stiffest wall that can be written.
HHD = DeviceStability(load_model("hhd"), 1000.0, lambda: 0.010, SettlingLibrary())
EMPTY = Scene()
STEEP = {"type": "spring", "stiffness_n_per_m": 1e6}
GENTLE = {"type": "spring", "stiffness_n_per_m": 100}


def scene(*walls: dict[str, Any]) -> Scene:
    shape = {"type": "plane", "point_m": [0, 0.18], "normal": [0, 1]}
    return Scene(walls=tuple(make_wall(f"w{n}", shape=shape, **wall) for n, wall in enumerate(walls)))


def test_wall_within_the_budget_is_let_in_as_it_was_written() -> None:
    after = scene({"law": GENTLE})
    admitted = admit_scene(HHD, EMPTY, after, force=False)
    assert admitted.scene == after
    assert admitted.admissions["w0"].budget.verdict != "unstable"


def test_steep_wall_is_refused_where_it_stands_in_the_document() -> None:
    after = scene({"law": GENTLE}, {"law": STEEP})
    with pytest.raises(Problem) as caught:
        admit_scene(HHD, EMPTY, after, force=False)
    assert caught.value.slug == "over-stability-budget"
    assert caught.value.pointer == "/walls/1/law/stiffness_n_per_m"
    with pytest.raises(Problem) as caught:
        admit_scene(HHD, EMPTY, after, force=False, about="w1")
    assert caught.value.pointer == "/law/stiffness_n_per_m"


def test_force_lets_a_steep_wall_in_under_passivity_and_touches_no_other() -> None:
    admitted = admit_scene(HHD, EMPTY, scene({"law": GENTLE}, {"law": STEEP}), force=True)
    assert [wall.law.passivity for wall in admitted.scene.walls] == [False, True]
    assert [admitted.admissions[name].forced for name in ("w0", "w1")] == [False, True]


def test_wall_that_renders_already_does_not_stand_in_the_way_of_another_edit() -> None:
    before = scene({"law": STEEP})
    moved = before.with_wall(before.walls[0].model_copy(update={"fade_s": 1.0}))
    assert admit_scene(HHD, before, moved, force=False).admissions == {}
    assert admit_scene(HHD, before, EMPTY, force=False).scene == EMPTY


def test_wall_that_is_off_is_asked_when_it_is_switched_on() -> None:
    off, on = scene({"law": STEEP, "enabled": False}), scene({"law": STEEP})
    assert admit_scene(HHD, EMPTY, off, force=False).scene == off
    with pytest.raises(Problem, match="limit"):
        admit_scene(HHD, off, on, force=False)
