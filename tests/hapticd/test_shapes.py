"""Shapes: what is refused and how, and what of each reaches the loop."""

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from hapticd import _core
from hapticd.flat_scene import flatten, flatten_shape
from hapticd.model import load_model
from hapticd.problem import Problem
from hapticd.scene import Scene
from hapticd.shapes import Shape
from hapticd.wall import Wall, check_wall
from hapticd_api.errors import refused_document
from tests.hapticd.conftest import make_wall

SHAPE: TypeAdapter[Shape] = TypeAdapter(Shape)

BALL: dict[str, Any] = {"type": "sphere", "center_m": [0.2, 0, 0], "radius_m": 0.02}
BLOCK: dict[str, Any] = {"type": "box", "center_m": [0.2, 0, 0], "size_m": [0.1, 0.08, 0.06]}
TILE: dict[str, Any] = {"type": "box", "center_m": [0, 0.2], "size_m": [0.1, 0.04]}
ROD: dict[str, Any] = {
    "type": "capsule",
    "from_m": [0.2, -0.05, 0],
    "to_m": [0.2, 0.05, 0],
    "radius_m": 0.01,
}
IN_SPACE = [
    {"type": "plane", "point_m": [0, 0, 0], "normal": [0, 0, 1]},
    BALL,
    BALL | {"hollow": True},
    BLOCK,
    BLOCK | {"orientation": [0.5, 0.5, 0.5, 0.5], "hollow": True},
    ROD,
]
IN_THE_PLANE = [
    {"type": "plane", "point_m": [0, 0], "normal": [0, 1]},
    BALL | {"center_m": [0, 0.2]},
    TILE,
    TILE | {"angle_rad": 0.3, "hollow": True},
    ROD | {"from_m": [0, 0.2], "to_m": [0.1, 0.2]},
]


@pytest.mark.parametrize(
    ("shape", "pointer", "words"),
    [
        (BALL | {"radius_m": 20}, "/radius_m", "less than or equal to 10"),
        (BALL | {"radius_m": 0}, "/radius_m", "greater than or equal to 0.0001"),
        (BALL | {"radius_m": -0.01}, "/radius_m", "greater than"),
        (BALL | {"hollow": "yes"}, "/hollow", "boolean"),
        (BALL | {"size_m": [1, 1, 1]}, "/size_m", "no field"),
        (BLOCK | {"size_m": [0.1, 0, 0.1]}, "/size_m/1", "0.0001"),
        (BLOCK | {"size_m": [0.1, 0.1]}, "/size_m", "2 edges"),
        (BLOCK | {"angle_rad": 0.3}, "/angle_rad", "orientation"),
        (BLOCK | {"orientation": [1, 1, 0, 0]}, "/orientation", "write [0.707107, 0.707107, 0.0, 0.0]"),
        (BLOCK | {"orientation": [0, 0, 1]}, "/orientation", "at least 4"),
        (TILE | {"orientation": [1, 0, 0, 0]}, "/orientation", "angle_rad"),
        (TILE | {"angle_rad": 90.0}, "/angle_rad", "less than or equal to 6.3"),
        (ROD | {"to_m": ROD["from_m"]}, "/to_m", "sphere"),
        (ROD | {"to_m": [0, 0]}, "/to_m", "2 coordinates"),
        ({"type": "torus"}, "/type", "'plane', 'sphere', 'box', 'capsule'"),
        ({"radius_m": 1}, "/type", "type"),
    ],
)
def test_bad_shape_is_refused_and_the_field_named(shape: dict[str, Any], pointer: str, words: str) -> None:
    with pytest.raises(ValidationError) as caught:
        SHAPE.validate_python(shape)
    errors = refused_document(caught.value.errors(), shape).errors
    assert errors is not None
    assert words in {entry["pointer"]: entry["message"] for entry in errors}[pointer]


@pytest.mark.parametrize("shape", IN_SPACE + IN_THE_PLANE)
def test_shape_comes_back_from_json_as_it_was(shape: dict[str, Any]) -> None:
    made = SHAPE.validate_python(shape)
    assert SHAPE.validate_json(SHAPE.dump_json(made)) == made


@pytest.mark.parametrize("shape", IN_THE_PLANE[1:])
def test_shape_of_another_dimension_is_refused(shape: dict[str, Any]) -> None:
    wall = make_wall("flat", shape=shape)
    check_wall(wall, 2)
    with pytest.raises(Problem, match="2 components, this device has 3"):
        check_wall(wall, 3)


@pytest.mark.parametrize(("model", "shapes"), [("phantom-1.0", IN_SPACE), ("hhd", IN_THE_PLANE)])
def test_core_takes_every_shape(model: str, shapes: list[dict[str, Any]]) -> None:
    loaded = load_model(model)
    simulation = _core.Simulation(loaded.device_json, loaded.twin_json, 1000.0, 1)
    walls = tuple(make_wall(f"w{n}", shape=shape) for n, shape in enumerate(shapes))
    flat, _ = flatten(Scene(walls=walls), 1, 0.1)
    assert simulation.request(json.dumps({"type": "scene", "scene": flat})) == 0


@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: math.hypot(*q) > 0.1))
def test_box_reaches_the_loop_turned_as_its_quaternion_turns_vectors(quaternion: list[float]) -> None:
    w, *v = np.array(quaternion) / math.hypot(*quaternion)
    box = SHAPE.validate_python(BLOCK | {"orientation": [w, *v]})
    edges = flatten_shape(box)["axes"]
    for edge, base in zip(edges, np.eye(3), strict=True):
        # q e q*, with the quaternion product written out.
        turned = base + 2 * w * np.cross(v, base) + 2 * np.cross(v, np.cross(v, base))
        assert np.allclose(edge, turned, atol=1e-9)


def test_rectangle_turns_to_the_left_and_reaches_far_across_its_plane() -> None:
    flat = flatten_shape(SHAPE.validate_python(TILE | {"angle_rad": math.pi / 2}))
    assert np.allclose(flat["axes"], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert flat["half_m"] == [0.05, 0.02, 10.0]
    assert flat["center_m"] == [0, 0.2, 0.0]


def test_what_was_granted_may_be_sent_back_and_is_no_part_of_the_wall() -> None:
    wall = make_wall("floor")
    assert Wall.model_validate(json.loads(wall.model_dump_json()) | {"granted": {"brake": True}}) == wall
