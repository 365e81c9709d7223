"""Every law × every edit while the hand is inside: no force steps, and the wall is there afterwards."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from tests.twin.stirred_wall import (
    LAWS,
    NEXT,
    OTHER,
    STIFFER,
    StirredWall,
    force_n,
    largest_step_n,
    step_max_n,
)

Scene = Mapping[str, Any]
Edit = Callable[[StirredWall], tuple[Scene, Scene]]

FADE_S = 0.1
ENABLED = 2
FELT_N = {"phantom-1.0": 0.1, "hhd": 1.0}
"""What the weakest law gives for sure while the hand stirs."""

LEFT_N = {"phantom-1.0": 0.2, "hhd": 2.5}
"""Without walls: what encoder steps pass through the spring drive, and the brakes' drag (KS §2.2)."""


def scene(*walls: dict[str, Any], **treatment: str) -> Scene:
    return {"walls": list(walls), **treatment}


KEEPING: dict[str, Edit] = {
    "move": lambda on: (scene(on.wall()), scene(on.wall(moved_m=0.002))),
    "stiffen": lambda on: (scene(on.wall()), scene(on.wall(law=STIFFER[on.law]))),
    "add": lambda on: (scene(on.wall()), scene(on.wall(), on.around())),
    "enable": lambda on: (scene(), scene(on.wall())),
    "replace": lambda on: (scene(on.wall()), scene(on.around(), on.wall(key=99, moved_m=0.001))),
    "mapping": lambda on: (scene(on.wall()), scene(on.wall(), mapping="inverse")),
    "law": lambda on: (scene(on.wall()), scene(on.wall(law=LAWS[NEXT[on.law]]))),
    "allocation": lambda on: (scene(on.wall()), scene(on.wall(), allocation="motor_only")),
}
"""Edits after which a wall is still around the tip."""

TAKING: dict[str, Edit] = {
    "disable": lambda on: (scene(on.wall()), scene()),
    "delete": lambda on: (scene(on.wall(), on.wall(key=OTHER)), scene()),
}
"""Edits after which none is."""

DEVICES = [("phantom-1.0", False), ("hhd", False), ("hhd", True)]
"""Each with brakes taking part or not."""


@pytest.mark.parametrize("passivity", [False, True], ids=["plain", "passivity"])
@pytest.mark.parametrize(("model", "brake"), DEVICES, ids=["phantom", "hhd-motors", "hhd-brakes"])
@pytest.mark.parametrize("edit", KEEPING)
@pytest.mark.parametrize("law", LAWS)
def test_edited_wall_is_felt_and_never_steps(
    law: str, edit: str, model: str, brake: bool, passivity: bool
) -> None:
    on = StirredWall(model, law, passivity=passivity, brake=brake)
    records = on.stir(*KEEPING[edit](on), FADE_S)
    assert largest_step_n(records) <= step_max_n(model)
    assert set(records["state"]) == {ENABLED}
    assert records["contact_count"][-1] >= 1
    assert force_n(records[-350:]).max() > FELT_N[model]


@pytest.mark.parametrize("passivity", [False, True], ids=["plain", "passivity"])
@pytest.mark.parametrize(("model", "brake"), DEVICES, ids=["phantom", "hhd-motors", "hhd-brakes"])
@pytest.mark.parametrize("edit", TAKING)
@pytest.mark.parametrize("law", LAWS)
def test_wall_that_is_taken_away_lets_go_and_never_steps(
    law: str, edit: str, model: str, brake: bool, passivity: bool
) -> None:
    on = StirredWall(model, law, passivity=passivity, brake=brake)
    records = on.stir(*TAKING[edit](on), FADE_S)
    assert largest_step_n(records) <= step_max_n(model)
    assert records["contact_count"][-1] == 0
    assert not records["brake_torque_nm"][-50:].any()
    assert not records["tip_force_demand_n"][-50:].any()
    assert force_n(records[-50:]).max() < LEFT_N[model]


@pytest.mark.parametrize("model", ["phantom-1.0", "hhd"])
@pytest.mark.parametrize("edit", {**KEEPING, **TAKING})
@pytest.mark.parametrize("law", LAWS)
def test_edit_that_does_not_fade_is_still_held_to_the_slew_limit(law: str, edit: str, model: str) -> None:
    on = StirredWall(model, law, passivity=True, brake=True)
    records = on.stir(*{**KEEPING, **TAKING}[edit](on), 0.0)
    assert largest_step_n(records) <= step_max_n(model)
    assert set(records["state"]) == {ENABLED}


BODIES = ["sphere", "box", "capsule"]


@pytest.mark.parametrize("model", ["phantom-1.0", "hhd"])
@pytest.mark.parametrize("hollow", [False, True], ids=["solid", "hollow"])
@pytest.mark.parametrize("body", BODIES)
def test_body_put_around_the_tip_and_moved_never_steps(body: str, hollow: bool, model: str) -> None:
    on = StirredWall(model, "spring", passivity=False, brake=True)
    around, moved = on.body(body, hollow=hollow), on.body(body, hollow=hollow, moved_m=0.004)
    for before, after in ((scene(), scene(around)), (scene(around), scene(moved))):
        records = StirredWall(model, "spring", passivity=False, brake=True).stir(before, after, FADE_S)
        assert largest_step_n(records) <= step_max_n(model)
        assert set(records["state"]) == {ENABLED}
        # A shell around the tip leaves it free inside; a solid body pushes it out.
        assert (records["contact_count"][-1] > 0) != hollow


@pytest.mark.parametrize("model", ["phantom-1.0", "hhd"])
@pytest.mark.parametrize("body", BODIES)
def test_wall_that_takes_another_shape_around_the_tip_never_steps(body: str, model: str) -> None:
    on = StirredWall(model, "motion", passivity=False, brake=True)
    records = on.stir(scene(on.wall()), scene(on.body(body, hollow=False)), FADE_S)
    assert largest_step_n(records) <= step_max_n(model)
    assert records["contact_count"][-1] > 0
