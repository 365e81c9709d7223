"""KS's hard spring on the HHD, with and without passivity control (KS Figs. 8 and 9)."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd.flat_wall import flat_plane
from hapticd.twin import TwinRun

SURFACE_M = 0.18
WEAK = {"force_n": 27.0, "speed_m_per_s": 0.25}
STRONG = {"force_n": 54.0, "speed_m_per_s": 1.5}
TOLERANCE_J = 4e-3
"""Twice the energy that the encoders hide (docs/passivity.md)."""


def spring(*, passivity: bool, stiffness_n_per_m: float = 150e3) -> dict[str, Any]:
    law = {"type": "spring", "stiffness_n_per_m": stiffness_n_per_m, "damping_n_s_per_m": 0.0}
    return flat_plane([0, 1, 0], SURFACE_M, law, passivity=passivity, brake=False)


def struck(contact: dict[str, float], *, passivity: bool, delay_ticks: int = 0) -> NDArray[Any]:
    """Records of 1.2 s in which the hand goes down onto the spring and pushes."""
    run = TwinRun("hhd", overrides={"twin.command_delay_ticks": delay_ticks})
    run.scene({"allocation": "motor_only", "walls": [spring(passivity=passivity)]})
    run.enable()
    run.run(0.5)
    run.hand({"type": "push", "direction": [0, -1, 0], **contact})
    return run.run(1.2)


def motion_m(records: NDArray[Any]) -> float:
    """Peak to peak motion of the tip across the wall over the last 0.2 s."""
    return float(np.ptp(records["tip_position_m"][-200:, 1]))


def bounces(records: NDArray[Any]) -> int:
    """How often the tip came back into contact."""
    touched = records["contact_count"] > 0
    return int((touched[1:] & ~touched[:-1]).sum()) - 1


@pytest.mark.parametrize("contact", [WEAK, STRONG], ids=["weak", "strong"])
def test_hard_spring_drives_the_hand_and_passivity_brings_it_to_rest(contact: dict[str, float]) -> None:
    active, passive = struck(contact, passivity=False), struck(contact, passivity=True)
    assert motion_m(active) > 1e-3
    assert active["device_energy_j"][-1] < -0.5
    assert motion_m(passive) < 5e-5
    assert bounces(passive) <= 1
    assert passive["device_energy_j"].min() > -TOLERANCE_J
    assert passive["contact_count"][-1] == 1


@pytest.mark.parametrize("contact", [WEAK, STRONG], ids=["weak", "strong"])
def test_a_tick_of_delay_that_nobody_told_the_controller_of_is_covered(contact: dict[str, float]) -> None:
    records = struck(contact, passivity=True, delay_ticks=1)
    assert motion_m(records) < 5e-5
    assert records["device_energy_j"].min() > -TOLERANCE_J


def test_spring_stiffened_under_the_hand_gives_no_more_than_it_got() -> None:
    run = TwinRun("hhd")
    run.scene({"allocation": "motor_only", "walls": [spring(passivity=True, stiffness_n_per_m=5e3)]})
    run.enable()
    run.run(0.5)
    run.hand({"type": "push", "direction": [0, -1, 0], **WEAK})
    pressed = run.run(1.0)
    stiffer = [spring(passivity=True, stiffness_n_per_m=150e3)]
    run.scene({"allocation": "motor_only", "walls": stiffer, "fade_s": 0.1})
    after = run.run(1.0)
    assert pressed["contact_depth_m"][-1] > 2e-3, "the soft wall lets the hand in"
    assert (after["contact_count"] == 1).all(), "the stiff one does not throw it out"
    assert after["device_energy_j"].min() > -TOLERANCE_J
    assert motion_m(after) < 2e-4


def test_record_names_the_wall_and_the_damping_while_control_acts() -> None:
    records = struck(WEAK, passivity=True)
    acts = (records["flags"] >> 6 & 1).astype(bool)
    assert acts.any()
    assert (records["passivity_wall"][acts] == 0).all()
    assert (records["passivity_damping_n_s_per_m"][~acts] == 0).all()
    assert (records["passivity_damping_n_s_per_m"][acts] > 0).any()
