"""A rigid wall on the HHD, pushed and released by the hand fitted to KS Figs. 8 and 9 (set R1)."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd.flat_wall import rigid_plane
from hapticd.twin import TwinRun

SURFACE_M = 0.18
WEAK = {"force_n": 27.0, "speed_m_per_s": 0.25}
STRONG = {"force_n": 54.0, "speed_m_per_s": 1.5}
MODES = ["motor_only", "motor_and_brake", "brake_only"]

SETTLED_M = 50e-6
"""Motion that counts as rest: half of KS' smallest bounce."""


class Wall:
    """An enabled HHD in front of a rigid wall below the tip."""

    def __init__(self, allocation: str, **overrides: Any) -> None:
        self.run = TwinRun(
            "hhd", overrides={key.replace("__", "."): value for key, value in overrides.items()}
        )
        wall = rigid_plane([0, 1, 0], SURFACE_M)
        self.run.scene({"allocation": allocation, "walls": [wall]})
        self.run.enable()
        self.run.run(0.5)

    def push(self, contact: dict[str, float]) -> NDArray[Any]:
        """Records of 1.2 s in which the hand goes down and pushes."""
        self.run.hand({"type": "push", "direction": [0, -1, 0], **contact})
        return self.run.run(1.2)


def motion_m(records: NDArray[Any]) -> float:
    """Peak to peak motion of the tip across the wall over the last 0.2 s."""
    return float(np.ptp(records["tip_position_m"][-200:, 1]))


def bounces(records: NDArray[Any]) -> int:
    """How often the tip came back into contact."""
    touched = records["contact_count"] > 0
    return int((touched[1:] & ~touched[:-1]).sum()) - 1


@pytest.mark.parametrize("contact", [WEAK, STRONG], ids=["weak", "strong"])
@pytest.mark.parametrize("allocation", MODES)
def test_a_push_comes_to_rest_in_the_wall(allocation: str, contact: dict[str, float]) -> None:
    records = Wall(allocation).push(contact)
    assert records["faults"][-1] == 0
    assert records["contact_count"][-1] == 1
    assert motion_m(records) < SETTLED_M
    assert bounces(records) <= 1


@pytest.mark.parametrize("contact", [WEAK, STRONG], ids=["weak", "strong"])
def test_the_tuning_stands_a_tick_of_delay_and_slippery_bearings(contact: dict[str, float]) -> None:
    slippery = [0.2, 0.2, 0.0]
    wall = Wall("motor_only", twin__command_delay_ticks=1, twin__friction__coulomb_nm=slippery)
    assert motion_m(wall.push(contact)) < SETTLED_M


def test_motors_alone_hold_the_push_at_the_coupling_stiffness() -> None:
    wall = Wall(
        "motor_only", twin__friction__coulomb_nm=[0.0, 0.0, 0.0], twin__sensor__bias_n=[0.0, 0.0, 0.0]
    )
    last = wall.push(WEAK)[-1]
    # The brakes' drag of 0.4 N·m carries up to 2.3 N of the 27 N.
    assert last["contact_depth_m"] * 60_000.0 == pytest.approx(27.0, abs=2.5)


@pytest.mark.parametrize("allocation", MODES)
def test_the_wall_lets_go_without_sticking(allocation: str) -> None:
    wall = Wall(allocation)
    wall.push(WEAK)
    wall.run.hand({"type": "follow", "target_m": [0.0, 0.22, 0.0]})
    released = wall.run.run(1.0)
    assert released["contact_count"][-1] == 0
    # Pulling off meets friction and the brakes' decay, never much of the push itself.
    outward_n = released["hand_force_n"][:, 1]
    assert outward_n.max() < 27.0
    assert released["faults"][-1] == 0


@pytest.mark.parametrize("allocation", MODES)
def test_a_tip_left_alone_in_the_wall_does_not_buzz(allocation: str) -> None:
    wall = Wall(allocation)
    wall.push(STRONG)
    wall.run.hand({"type": "free"})
    assert motion_m(wall.run.run(0.6)) < SETTLED_M


def test_tip_force_stays_inside_its_limit_in_a_strong_contact() -> None:
    records = Wall("motor_only").push(STRONG)
    assert np.linalg.norm(records["tip_force_command_n"], axis=1).max() <= 105.0 * 1.001
