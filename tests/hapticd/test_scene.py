"""The scene: what is refused and how, and what reaches the loop."""

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hapticd import _core
from hapticd.flat_scene import edit_fade_s, flatten
from hapticd.flat_wall import rigid_plane, wall_key
from hapticd.model import load_model
from hapticd.problem import Problem
from hapticd.scene import MAX_WALLS, Scene, check_scene
from hapticd.wall import Wall
from hapticd_api.errors import refused_document


def wall(**changes: Any) -> dict[str, Any]:
    document: dict[str, Any] = {
        "id": "floor",
        "shape": {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]},
        "law": {"type": "motion", "eta": 0.0},
    }
    return document | changes


def plane(point_m: list[float], normal: list[float]) -> dict[str, Any]:
    return {"type": "plane", "point_m": point_m, "normal": normal}


def problem_of(document: dict[str, Any]) -> Problem:
    with pytest.raises(ValidationError) as caught:
        Scene.model_validate(document)
    return refused_document(caught.value.errors(), document)


def test_wall_of_the_api_document_is_accepted() -> None:
    scene = Scene.model_validate({"walls": [wall(enabled=True, fade_s=0.2)]})
    assert scene.wall("floor") == scene.walls[0]
    assert (scene.mapping, scene.stiffness, scene.allocation) == ("transpose", "pose", "motor_and_brake")


def test_scene_comes_back_from_json_as_it_was() -> None:
    scene = Scene.model_validate({"walls": [wall()], "note": "first", "mapping": "inverse"})
    assert Scene.model_validate(json.loads(scene.model_dump_json())) == scene


@pytest.mark.parametrize(
    ("document", "pointer", "words"),
    [
        (wall(law={"type": "motion", "eta": 1.2}), "/walls/0/law/eta", "less than or equal to 1"),
        (wall(law={"type": "motion", "eta": -0.1}), "/walls/0/law/eta", "greater than or equal to 0"),
        (wall(law={"type": "motion", "eta": math.nan}), "/walls/0/law/eta", "finite"),
        (wall(law={"type": "motion", "eta": "0.5"}), "/walls/0/law/eta", "number"),
        (wall(law={"type": "motion", "eta": True}), "/walls/0/law/eta", "number"),
        (wall(law={"type": "sticky", "eta": 0.5}), "/walls/0/law/type", "'motion'"),
        (wall(shape=plane([0, 0, 0], [0, 0, 0])), "/walls/0/shape/normal", "zero"),
        (wall(shape=plane([0, 0, 0], [0, 0, 2])), "/walls/0/shape/normal", "write [0.0, 0.0, 1.0]"),
        (wall(shape=plane([0, 0, 0], [0, 0, math.inf])), "/walls/0/shape/normal/2", "finite"),
        (wall(shape=plane([0, 0, -20], [0, 0, 1])), "/walls/0/shape/point_m/2", "-10"),
        (wall(shape=plane([0], [1])), "/walls/0/shape/point_m", "at least 2"),
        (wall(shape=plane([0, 0, 0], [0, 1])), "/walls/0/shape", "agree"),
        (
            wall(shape={"type": "ball", "radius_m": 1}),
            "/walls/0/shape/type",
            "'plane', 'sphere', 'box', 'capsule'",
        ),
        (wall(id="Floor 1"), "/walls/0/id", "pattern"),
        (wall(colour="red"), "/walls/0/colour", "'colour'"),
        (wall(fade_s=60.0), "/walls/0/fade_s", "less than or equal to 5"),
    ],
)
def test_bad_wall_is_refused_and_the_field_named(document: dict[str, Any], pointer: str, words: str) -> None:
    errors = problem_of({"walls": [document]}).errors
    assert errors is not None
    assert words in {entry["pointer"]: entry["message"] for entry in errors}[pointer]


def test_two_walls_with_one_id_are_refused() -> None:
    problem = problem_of({"walls": [wall(), wall()]})
    assert problem.pointer == "/walls"
    assert "'floor'" in problem.detail


def test_ten_thousand_walls_are_refused() -> None:
    problem = problem_of({"walls": [wall(id=f"w{index}") for index in range(10_000)]})
    assert problem.pointer == "/walls"
    assert str(MAX_WALLS) in problem.detail


def test_one_wall_more_than_the_most_is_refused() -> None:
    full = Scene.model_validate({"walls": [wall(id=f"w{index}") for index in range(MAX_WALLS)]})
    with pytest.raises(Problem) as caught:
        full.with_wall(Wall.model_validate(wall(id="one-more")))
    assert caught.value.slug == "too-many-walls"
    assert len(full.with_wall(Wall.model_validate(wall(id="w3"))).walls) == MAX_WALLS


def test_wall_of_another_dimension_is_refused() -> None:
    flat = Scene.model_validate({"walls": [wall(id="a", shape=plane([0, 0], [0, 1])), wall(id="b")]})
    with pytest.raises(Problem) as caught:
        check_scene(flat, 2)
    assert (caught.value.slug, caught.value.pointer) == ("dimension-mismatch", "/walls/1/shape/point_m")
    with pytest.raises(Problem) as caught:
        check_scene(flat, 3)
    assert caught.value.pointer == "/walls/0/shape/point_m"


def test_replacing_a_wall_keeps_its_place() -> None:
    scene = Scene.model_validate({"walls": [wall(id=name) for name in "abc"]})
    edited = scene.with_wall(Wall.model_validate(wall(id="b", enabled=False)))
    assert [each.id for each in edited.walls] == ["a", "b", "c"]
    assert edited.walls[1].enabled is False
    assert [each.id for each in edited.without_wall("a").walls] == ["b", "c"]


@given(
    angle=st.floats(0, 2 * math.pi),
    stretch=st.floats(1 - 9e-4, 1 + 9e-4),
    point=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
)
def test_normal_off_by_rounding_reaches_the_loop_at_unit_length(
    angle: float, stretch: float, point: tuple[float, float]
) -> None:
    normal = [math.cos(angle) * stretch, math.sin(angle) * stretch]
    scene = Scene.model_validate({"walls": [wall(shape=plane(list(point), normal))]})
    flat, _ = flatten(scene, 1, 0.0)
    sent = flat["walls"][0]
    assert math.isclose(math.hypot(*sent["shape"]["normal"]), 1.0, abs_tol=1e-12)
    assert sent["shape"]["normal"][2] == 0.0
    # The plane still goes through its point.
    assert math.isclose(
        sent["shape"]["normal"][0] * point[0] + sent["shape"]["normal"][1] * point[1],
        sent["shape"]["offset_m"],
        abs_tol=1e-12,
    )


def test_flat_scene_holds_enabled_walls_in_order_with_their_ids() -> None:
    scene = Scene.model_validate(
        {
            "mapping": "inverse",
            "stiffness": "workspace",
            "allocation": "brake_only",
            "walls": [
                wall(id="a"),
                wall(id="b", enabled=False),
                wall(id="c", law={"type": "motion", "eta": 0.5}),
            ],
        }
    )
    flat, ids = flatten(scene, 7, 0.25)
    assert ids == ["a", "c"]
    assert flat == {
        "revision": 7,
        "fade_s": 0.25,
        "mapping": "inverse",
        "stiffness": "workspace",
        "allocation": "brake_only",
        "walls": [
            rigid_plane([0.0, 0.0, 1.0], -0.02, key=wall_key("a")),
            rigid_plane([0.0, 0.0, 1.0], -0.02, eta=0.5, key=wall_key("c")),
        ],
    }


def test_core_takes_the_largest_scene_the_model_lets_through() -> None:
    model = load_model("phantom-1.0")
    simulation = _core.Simulation(model.device_json, model.twin_json, 1000.0, 1)
    full = Scene.model_validate({"walls": [wall(id=f"w{index}") for index in range(MAX_WALLS)]})
    for mapping in ("transpose", "inverse"):
        for stiffness in ("pose", "workspace"):
            for allocation in ("motor_only", "motor_and_brake", "brake_only"):
                treatment = {"mapping": mapping, "stiffness": stiffness, "allocation": allocation}
                flat, _ = flatten(full.model_copy(update=treatment), 1, 0.2)
                assert simulation.request(json.dumps({"type": "scene", "scene": flat})) == 0


def test_edit_fades_as_slowly_as_the_slowest_wall_that_changes() -> None:
    before = Scene.model_validate({"walls": [wall(id="kept", fade_s=4.0), wall(id="gone", fade_s=0.7)]})
    after = before.without_wall("gone").with_wall(Wall.model_validate(wall(id="new", fade_s=0.3)))
    assert edit_fade_s(before, after) == 0.7
    assert edit_fade_s(before, before.model_copy(update={"mapping": "inverse"})) == 4.0
    assert edit_fade_s(Scene(), Scene()) == 0.0
