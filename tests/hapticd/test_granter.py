"""What walls are granted: never more than the device can give, and why."""

from typing import Any

import pytest

from hapticd.granter import Granter
from hapticd.model import load_model
from hapticd.scene import Scene
from hapticd.scene_result import Granted
from tests.hapticd.conftest import make_wall

PHANTOM = Granter.of_model(load_model("phantom-1.0"))
HHD = Granter.of_model(load_model("hhd"))
K_C = 2000.0


def granted(
    granter: Granter, k_c: float | None = K_C, allocation: str = "motor_and_brake", **wall: Any
) -> Granted:
    scene = Scene.model_validate({"allocation": allocation})
    return granter.wall(make_wall("floor", **wall), scene, k_c)


def spring(stiffness_n_per_m: float, **more: Any) -> dict[str, Any]:
    return {"type": "spring", "stiffness_n_per_m": stiffness_n_per_m, **more}


def test_spring_beyond_the_spring_drive_gets_what_the_pose_gives_and_is_told() -> None:
    outcome = granted(PHANTOM, law=spring(5000, damping_n_s_per_m=3))
    assert (outcome.stiffness_n_per_m, outcome.stiffness_fraction) == (K_C, 1.0)
    assert outcome.damping_n_s_per_m == 3
    assert outcome.why[0] == "The spring drive can give at most 2000 N/m at this pose, not 5000 N/m."


def test_spring_within_the_spring_drive_is_granted_whole_as_a_fraction_of_what_it_gives() -> None:
    outcome = granted(PHANTOM, law=spring(800))
    assert (outcome.stiffness_n_per_m, outcome.stiffness_fraction) == (800, 0.4)
    assert outcome.why[0] == "800 N/m is 40% of the 2000 N/m that the spring drive gives at this pose."


def test_motion_wall_is_the_complement_of_eta_of_what_the_device_gives() -> None:
    assert granted(PHANTOM, eta=0.25).stiffness_n_per_m == 1500.0
    hhd = granted(HHD, eta=0.25)
    assert (hhd.stiffness_n_per_m, hhd.damping_n_s_per_m) == (45_000.0, 150.0)


@pytest.mark.parametrize("law", [{"type": "motion", "eta": 0.0}, spring(800)])
def test_stiffness_of_a_spring_drive_that_is_offline_is_not_guessed(law: dict[str, Any]) -> None:
    outcome = granted(PHANTOM, k_c=None, law=law)
    assert outcome.stiffness_n_per_m is None
    assert "offline" in outcome.why[0]
    assert granted(HHD, k_c=None, law=law).stiffness_n_per_m is not None


def test_dampers_hold_nothing() -> None:
    assert granted(HHD, law={"type": "damper", "damping_n_s_per_m": 7}).stiffness_n_per_m == 0.0
    cubic = granted(HHD, law={"type": "cubic_damper", "form": "explicit"})
    assert (cubic.stiffness_n_per_m, cubic.damping_n_s_per_m) == (0.0, None)
    assert "1.6e+06" in cubic.why[0]


@pytest.mark.parametrize(
    ("granter", "brake", "allocation", "takes_part"),
    [
        (HHD, None, "motor_and_brake", True),
        (HHD, True, "brake_only", True),
        (HHD, False, "motor_and_brake", False),
        (HHD, None, "motor_only", False),
        (PHANTOM, None, "motor_and_brake", False),
    ],
)
def test_brakes_take_part_where_device_wall_and_scene_let_them(
    granter: Granter, brake: bool | None, allocation: str, takes_part: bool
) -> None:
    assert granted(granter, allocation=allocation, law=spring(800, brake=brake)).brake is takes_part


@pytest.mark.parametrize(
    ("granter", "asked", "renders"),
    [(HHD, "auto", "brake"), (HHD, "motor", "motor"), (PHANTOM, "auto", "motor")],
)
def test_friction_is_rendered_by_what_the_device_has(granter: Granter, asked: str, renders: str) -> None:
    friction = {"static": 0.4, "kinetic": 0.3, "actuator": asked}
    assert granted(granter, friction=friction).friction_actuator == renders
    assert granted(granter).friction_actuator is None


def test_passivity_is_told_with_its_reason() -> None:
    outcome = granted(HHD, law=spring(800, passivity=True))
    assert outcome.passivity
    assert any("Passivity is on" in sentence for sentence in outcome.why)
    assert not granted(HHD, law=spring(800)).passivity


def test_walls_that_are_off_are_granted_nothing() -> None:
    scene = Scene(walls=(make_wall("on"), make_wall("off", enabled=False)))
    assert [wall.id for wall in PHANTOM.walls(scene, K_C)] == ["on"]
