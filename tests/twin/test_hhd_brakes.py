"""Motors and brakes sharing a wall on the HHD (KS §3, Fig. 5)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.flat_wall import flat_plane, rigid_plane
from hapticd.twin import TwinRun

QUIET = {
    "twin.friction.coulomb_nm": [0.0, 0.0, 0.0],
    "twin.brake.hysteresis_scale": 0.0,
    "twin.brake.ripple": 0.0,
    "brakes.hysteresis": 0.0,
    "brakes.drag_nm": [0.0, 0.0, 0.0],
    "twin.sensor.bias_n": [0.0, 0.0, 0.0],
}
"""Nothing but motors and brakes acts on the tip."""

ONE_OF_EACH = {
    **QUIET,
    "brakes.torque_max_nm": [1e-3, 10.0, 0.0],
    "twin.motor.torque_scale": [1.0, 1e-9, 1.0],
}
"""KS Fig. 5: joint 1 has its motor alone, joint 2 its brake alone."""

MOVING_M_PER_S = 0.05


def compressed_and_released(overrides: dict[str, Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Records of a clamp that moves the tip 20 mm into a soft wall with normal −y, and out again."""
    run = TwinRun("hhd", overrides=overrides)
    run.scene({"walls": [rigid_plane([0, -1, 0], -0.2, eta=0.98)]})
    run.enable()
    run.hand({"type": "clamp", "position_m": [0.0, 0.18, 0.0]})
    run.run(1.5)
    run.hand({"type": "clamp", "position_m": [0.0, 0.22, 0.0]})
    compression = run.run(1.0)
    run.hand({"type": "clamp", "position_m": [0.0, 0.195, 0.0]})
    release = run.run(1.0)
    return compression, release


def off_normal_deg(records: NDArray[Any]) -> NDArray[np.float64]:
    """Angle between the force on the clamp and the wall normal −y."""
    force = -records["hand_force_n"]
    angles: NDArray[np.float64] = np.degrees(np.abs(np.arctan2(force[:, 0], -force[:, 1])))
    return angles


def test_one_motor_and_one_brake_push_along_the_normal_in_compression() -> None:
    compression, _ = compressed_and_released(ONE_OF_EACH)
    held = compression[-300:]
    assert held["contact_count"].all()
    assert off_normal_deg(held).max() < 1.0
    brake_nm = held["joint_torque_demand_nm"][:, 1]
    assert np.abs(brake_nm).min() > 3.0, "the brake's axis carries its share"


def test_one_motor_and_one_brake_cannot_push_along_the_normal_in_release() -> None:
    _, release = compressed_and_released(ONE_OF_EACH)
    leaving = release[
        (release["contact_count"] > 0) & (release["tip_velocity_m_per_s"][:, 1] < -MOVING_M_PER_S)
    ]
    angles_deg = off_normal_deg(leaving)
    # At (0, 200) mm the motor alone pushes along the other link, 60° off the normal; while the brake
    # still holds it turns the force to 90° (KS Fig. 5b).
    assert angles_deg.max() < 92.0
    assert angles_deg[:60].max() > 80.0
    assert 55.0 < np.median(angles_deg) < 85.0
    assert not leaving["brake_torque_nm"][5:].any(), "the brake is let go as soon as it cannot help"


def test_motors_beside_the_brakes_keep_the_force_on_the_normal_in_release() -> None:
    compression, release = compressed_and_released(QUIET)
    leaving = release[
        (release["contact_depth_m"] > 1e-3) & (release["tip_velocity_m_per_s"][:, 1] < -MOVING_M_PER_S)
    ]
    assert off_normal_deg(compression[-300:]).max() < 3.0
    assert off_normal_deg(leaving).max() < 3.0


def test_no_brake_is_asked_for_torque_in_its_direction_of_motion() -> None:
    # Law 7 in closed loop: through a corner, with a swinging hand, on the imperfect device.
    run = TwinRun("hhd")
    walls = [
        rigid_plane([0.0, 1.0, 0.0], 0.19, eta=0.5),
        rigid_plane([-0.6, 0.8, 0.0], 0.14, eta=0.8, key=2),
    ]
    run.scene({"walls": walls})
    run.enable()
    run.hand(
        {
            "type": "stroke",
            "center_m": [0.0, 0.19, 0.0],
            "axis": [1, 1, 0],
            "amplitude_m": 0.03,
            "frequency_hz": 2.0,
        }
    )
    records = run.run(4.0)
    velocity = records["joint_velocity_rad_per_s"]
    wrong = (records["brake_torque_nm"] > 0) & (np.abs(velocity) > 0.06)
    wrong &= records["joint_torque_demand_nm"] * velocity > 0
    assert (records["brake_torque_nm"] > 1.0).any()
    assert not wrong.any()


LATE = {"brakes.dead_time_s": 0.058, "twin.brake.dead_time_s": 0.058}
CUBIC = {"type": "cubic_damper", "coefficient_n_s3_per_m3": 1.28e7, "form": "implicit"}


def test_hand_that_leaves_a_wall_that_held_it_pulls_against_little_of_the_brakes() -> None:
    # They hold 36 N and more, and need 0.1 s to let go. Friction alone asks for 8 N.
    run = TwinRun("hhd", overrides=LATE)
    run.scene({"walls": [flat_plane([0, 1, 0], 0.18, CUBIC)]})
    run.enable()
    run.run(0.5)
    run.hand({"type": "push", "direction": [0, -1, 0], "force_n": 54.0, "speed_m_per_s": 1.5})
    held = run.run(1.5)[-1]
    run.hand({"type": "follow", "target_m": [0, 0.22, 0]})
    leaving = run.run(0.3)
    assert held["brake_torque_nm"].max() > 9.0
    assert leaving["hand_force_n"][:, 1].max() < 22.0
    assert leaving["contact_count"][-1] == 0
