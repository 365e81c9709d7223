"""Stick and slip on the twins: what a hand feels along a rubbing wall (KS §5, Fig. 10b)."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd.flat_wall import flat_plane
from hapticd.twin import TwinRun

STATIC, KINETIC = 0.6, 0.4
STICK, SLIP = 1, 2
MOVING_M_PER_S = 0.05

QUIET = {
    "twin.friction.coulomb_nm": [0.0, 0.0, 0.0],
    "twin.friction.viscous_nm_s_per_rad": [0.0, 0.0, 0.0],
    "twin.brake.hysteresis_scale": 0.0,
    "twin.brake.ripple": 0.0,
    "brakes.hysteresis": 0.0,
    "brakes.drag_nm": [0.0, 0.0, 0.0],
    "twin.sensor.bias_n": [0.0, 0.0, 0.0],
}
"""Nothing but the friction of the wall rubs."""

SMOOTH = {"twin.friction.coulomb_nm": [0.0, 0.0, 0.0], "twin.winding.brush_ripple": 0.0}


def friction(actuator: str) -> dict[str, Any]:
    """Friction of a wall."""
    return {"static": STATIC, "kinetic": KINETIC, "actuator": actuator}


def rubbed(run: TwinRun, wall: dict[str, Any], start: list[float], end: list[float]) -> NDArray[Any]:
    """Records of a hand that goes to ``start``, behind the wall, rests there, and goes on to ``end``."""
    run.scene({"walls": [wall]})
    run.enable()
    run.run(0.4)
    run.hand({"type": "follow", "target_m": start})
    run.run(1.2)
    run.hand({"type": "minimum_jerk", "from_m": start, "to_m": end, "duration_s": 1.2})
    return run.run(1.8)


def on_hhd(actuator: str) -> NDArray[Any]:
    """The HHD pressed on a wall with some 18 N and rubbed along x."""
    wall = flat_plane(
        [0, 1, 0], 0.19, {"type": "motion", "eta": 0.0}, brake=False, friction=friction(actuator)
    )
    return rubbed(TwinRun("hhd", overrides=QUIET), wall, [-0.05, 0.171, 0.0], [0.05, 0.171, 0.0])


def on_phantom() -> NDArray[Any]:
    """The PHANTOM pressed on a floor with some 3 N and rubbed along y."""
    floor = flat_plane([0, 0, 1], 0.02, {"type": "motion", "eta": 0.0}, friction=friction("auto"))
    run = TwinRun("phantom-1.0", overrides=SMOOTH)
    return rubbed(run, floor, [0.2, -0.03, 0.006], [0.2, 0.03, 0.006])


def pulls(records: NDArray[Any], along: int, across: int) -> tuple[float, float]:
    """Force of the hand along the wall over the one across it: just before the break-away, and its mean in
    slip between two moments of equal speed, so that inertia drops out."""
    force = records["hand_force_n"]
    ratio = force[:, along] / -force[:, across]
    fast = np.flatnonzero(records["tip_velocity_m_per_s"][:, along] > MOVING_M_PER_S)
    broke = int(np.flatnonzero(records["friction_state"][: fast[0]] == STICK)[-1])
    return float(ratio[broke - 20 : broke + 1].max()), float(ratio[fast[0] : fast[-1]].mean())


@pytest.mark.parametrize("actuator", ["motor", "brake"])
def test_pull_on_the_hhd_rises_to_the_static_force_and_drops_to_the_kinetic_one(actuator: str) -> None:
    records = on_hhd(actuator)
    peak, steady = pulls(records, along=0, across=1)
    assert peak == pytest.approx(STATIC, rel=0.12)
    assert steady == pytest.approx(KINETIC, rel=0.06)
    assert records["faults"][-1] == 0


def test_pull_on_the_phantom_rises_to_the_static_force_and_drops_to_the_kinetic_one() -> None:
    records = on_phantom()
    peak, steady = pulls(records, along=1, across=2)
    assert peak == pytest.approx(STATIC, rel=0.06)
    assert steady == pytest.approx(KINETIC, rel=0.06)
    assert records["faults"][-1] == 0


def test_stick_is_flagged_and_holds_still_without_chatter() -> None:
    for records, along in ((on_hhd("motor"), 0), (on_phantom(), 1)):
        states = records["friction_state"]
        assert {STICK, SLIP} <= set(states)
        sticks = records["flags"] >> np.uint64(7) & np.uint64(1)
        assert (sticks.astype(bool) == (states == STICK)).all()
        rest = records[-200:]
        assert (rest["friction_state"] == STICK).all()
        assert np.ptp(rest["tip_position_m"][:, along]) < 1e-4


def test_brakes_give_the_friction_and_motors_the_normal_force() -> None:
    records = on_hhd("brake")
    slides = (records["friction_state"] == SLIP) & (records["tip_velocity_m_per_s"][:, 0] > MOVING_M_PER_S)
    assert (records["brake_torque_nm"][slides][50:, :2] > 0.3).all()
    assert np.abs(records["tip_force_command_n"][slides][100:, 0]).max() < 1.5


def held_sideways() -> tuple[TwinRun, np.void]:
    """The HHD pressed on a wall and pulled aside below the static force, by motors alone; the last record."""
    run = TwinRun("hhd", overrides=QUIET)
    run.scene({"walls": [rubbing_wall(0.19)], "allocation": "motor_only"})
    run.enable()
    run.run(0.4)
    run.hand({"type": "follow", "target_m": [0.006, 0.171, 0.0]})
    stuck = run.run(1.2)[-1]
    assert stuck["friction_state"] == STICK
    assert stuck["hand_force_n"][0] > 2.0
    return run, stuck


def rubbing_wall(surface_m: float) -> dict[str, Any]:
    """A rigid wall below the tip."""
    return flat_plane([0, 1, 0], surface_m, {"type": "motion", "eta": 0.0}, friction=friction("auto"))


def test_hand_that_lets_go_of_a_stuck_tip_is_not_driven() -> None:
    run, _ = held_sideways()
    run.hand({"type": "free"})
    left = run.run(0.5)
    assert np.abs(left["tip_velocity_m_per_s"][:, 0]).max() < 0.02
    assert not left["friction_force_n"][50:].any()


def test_wall_that_moves_under_a_stuck_hand_takes_its_anchor_along_without_a_step() -> None:
    run, stuck = held_sideways()
    run.scene({"walls": [rubbing_wall(0.1905)], "allocation": "motor_only", "fade_s": 0.5})
    moved = run.run(0.8)
    assert moved["hand_force_n"][-1, 1] < stuck["hand_force_n"][1] - 0.2, "the hand is lifted"
    assert moved["friction_state"][-1] == STICK
    first_n = np.diff(moved["friction_force_n"][:20, 0])
    assert np.abs(first_n).max() < 1.0, "more than the spring and damper of one count"
    assert np.abs(moved["tip_position_m"][:, 0] - stuck["tip_position_m"][0]).max() < 5e-4
