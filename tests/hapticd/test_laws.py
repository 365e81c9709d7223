"""Laws and friction: what is refused and how, and what of each reaches the loop."""

import json
from typing import Any

import pytest
from pydantic import ValidationError

from hapticd import _core
from hapticd.flat_scene import flatten, flatten_wall
from hapticd.model import load_model
from hapticd.problem import Problem
from hapticd.scene import Scene, check_scene
from hapticd.scene_store import StoredScene
from hapticd.wall import Wall
from hapticd_api.errors import refused_document
from tests.hapticd.conftest import make_wall

SPRING: dict[str, Any] = {"type": "spring", "stiffness_n_per_m": 800}
DAMPER: dict[str, Any] = {"type": "damper", "damping_n_s_per_m": 10}
CUBIC: dict[str, Any] = {"type": "cubic_damper"}
LAWS = [{"type": "motion", "eta": 0.5}, SPRING, SPRING | {"passivity": True}, DAMPER, CUBIC]


def errors_of(**changes: Any) -> dict[str, str]:
    """Messages of the refusal of a wall, by pointer."""
    document = {**make_wall("floor").model_dump(mode="json"), **changes}
    with pytest.raises(ValidationError) as caught:
        Wall.model_validate(document)
    errors = refused_document(caught.value.errors(), document).errors
    assert errors is not None
    return {entry["pointer"]: entry["message"] for entry in errors}


@pytest.mark.parametrize(
    ("law", "pointer", "words"),
    [
        (SPRING | {"stiffness_n_per_m": 0}, "/law/stiffness_n_per_m", "greater than 0"),
        (SPRING | {"stiffness_n_per_m": 2e6}, "/law/stiffness_n_per_m", "1000000"),
        (SPRING | {"damping_n_s_per_m": -1}, "/law/damping_n_s_per_m", "greater than or equal to 0"),
        (SPRING | {"eta": 0.5}, "/law/eta", "no field 'eta'"),
        (DAMPER | {"damping_n_s_per_m": 0}, "/law/damping_n_s_per_m", "greater than 0"),
        ({"type": "damper"}, "/law/damping_n_s_per_m", "required"),
        (CUBIC | {"form": "rounded"}, "/law/form", "'implicit' or 'explicit'"),
        (CUBIC | {"coefficient_n_s3_per_m3": -1}, "/law/coefficient_n_s3_per_m3", "greater than 0"),
        (SPRING | {"passivity": 1}, "/law/passivity", "boolean"),
        ({"type": "glue"}, "/law/type", "'motion', 'spring', 'damper', 'cubic_damper'"),
    ],
)
def test_bad_law_is_refused_and_the_field_named(law: dict[str, Any], pointer: str, words: str) -> None:
    assert words in errors_of(law=law)[pointer]


@pytest.mark.parametrize(
    ("friction", "pointer", "words"),
    [
        ({"static": 0.3, "kinetic": 0.4}, "/friction/kinetic", "at most 0.3"),
        ({"static": 50, "kinetic": 0.4}, "/friction/static", "less than or equal to 5"),
        ({"static": -0.1, "kinetic": 0}, "/friction/static", "greater than or equal to 0"),
        ({"static": 0.3}, "/friction/kinetic", "required"),
        ({"static": 0.3, "kinetic": 0.3, "actuator": "glue"}, "/friction/actuator", "'brake'"),
    ],
)
def test_bad_friction_is_refused_and_the_field_named(
    friction: dict[str, Any], pointer: str, words: str
) -> None:
    assert words in errors_of(friction=friction)[pointer]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("model", ["phantom-1.0", "hhd"])
def test_core_takes_every_law_with_friction(model: str, law: dict[str, Any]) -> None:
    loaded = load_model(model)
    simulation = _core.Simulation(loaded.device_json, loaded.twin_json, 1000.0, 1)
    wall = make_wall("floor", law=law, friction={"static": 0.4, "kinetic": 0.3})
    flat, _ = flatten(Scene(walls=(wall,)), 1, 0.1)
    assert simulation.request(json.dumps({"type": "scene", "scene": flat})) == 0


@pytest.mark.parametrize("law", LAWS)
def test_wall_with_law_and_friction_comes_back_from_json_as_it_was(law: dict[str, Any]) -> None:
    wall = make_wall("floor", law=law, friction={"static": 0.4, "kinetic": 0.3, "actuator": "motor"})
    assert Wall.model_validate(json.loads(wall.model_dump_json())) == wall


def test_loop_gets_passivity_and_brake_beside_the_law() -> None:
    flat = flatten_wall(make_wall("floor", law=SPRING | {"passivity": True, "brake": False}))
    assert flat["law"] == {"type": "spring", "stiffness_n_per_m": 800, "damping_n_s_per_m": 0.0}
    assert (flat["passivity"], flat["brake"]) == (True, False)
    assert flatten_wall(make_wall("floor", law=SPRING))["brake"] is True


def test_cubic_damper_takes_the_coefficient_of_its_form_unless_told() -> None:
    def coefficient(**changes: Any) -> float:
        law = flatten_wall(make_wall("floor", law=CUBIC | changes))["law"]
        return float(law["coefficient_n_s3_per_m3"])

    assert coefficient(form="explicit") == 1.6e6  # KS §4
    assert coefficient() > coefficient(form="explicit")
    assert coefficient(coefficient_n_s3_per_m3=5e5) == 5e5


@pytest.mark.parametrize(
    ("changes", "pointer"),
    [
        ({"law": SPRING | {"brake": True}}, "/walls/0/law/brake"),
        (
            {"friction": {"static": 0.4, "kinetic": 0.3, "actuator": "brake"}},
            "/walls/0/friction/actuator",
        ),
    ],
)
def test_brakes_are_refused_where_there_are_none(changes: dict[str, Any], pointer: str) -> None:
    scene = Scene(walls=(make_wall("floor", **changes),))
    check_scene(scene, 3, brakes=True)
    with pytest.raises(Problem) as caught:
        check_scene(scene, 3, brakes=False)
    assert (caught.value.slug, caught.value.status, caught.value.pointer) == ("no-brakes", 422, pointer)


def test_scene_stored_before_there_were_other_laws_still_loads() -> None:
    law = {"type": "motion", "eta": 0.25}
    shape = {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]}
    wall = {"id": "floor", "shape": shape, "law": law, "enabled": True, "fade_s": 0.2}
    stored = StoredScene.model_validate_json(json.dumps({"revision": 3, "scene": {"walls": [wall]}}))
    assert stored.scene.walls == (make_wall("floor", eta=0.25),)
