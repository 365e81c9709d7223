"""Where the PHANTOM's tip force points: WN Fig. 6 on the twin, 24 wall directions."""

import numpy as np

from tests.oracle.linkage import jacobian, phantom
from tests.oracle.stiffness import direction_error_rad
from tests.twin.clamped_phantom import COLD, DIRECTIONS_RAD, IDEAL, POSE_RAD, ClampedPhantom, normal

DEPTH_M = 1e-3

LOADS_JOINT_2_ALONE = normal(np.radians(120.0))
"""Across the forearm's column of the Jacobian."""


def soft_axis_rad() -> float:
    """Angle of the direction in which locked joints are softest: the longest axis of J Jᵀ."""
    j = jacobian(lambda q: phantom(q, 0.14, 0.14), np.array(POSE_RAD))[np.ix_([0, 2], [1, 2])]
    longest = np.linalg.eigh(j @ j.T).eigenvectors[:, -1]
    return float(np.arctan2(longest[1], longest[0]))


def test_transpose_mapping_pushes_along_the_wall_normal_within_half_a_degree() -> None:
    errors_deg = ClampedPhantom(IDEAL, "transpose").force_errors_deg(DEPTH_M)
    assert np.abs(errors_deg).max() < 0.5, errors_deg


def test_inverse_mapping_errs_as_the_closed_form_says_within_one_degree() -> None:
    errors_deg = ClampedPhantom({**IDEAL, **COLD}, "inverse").force_errors_deg(DEPTH_M)
    expected_deg = np.degrees(
        direction_error_rad(DIRECTIONS_RAD - soft_axis_rad(), POSE_RAD[2] - POSE_RAD[1])
    )
    assert np.abs(errors_deg - expected_deg).max() < 1.0, errors_deg - expected_deg
    assert np.abs(errors_deg).max() > 29.0, "the largest error is |q3 − q2| = 30°"


def test_transpose_mapping_keeps_its_direction_when_one_motor_is_warmer() -> None:
    phantom = ClampedPhantom(IDEAL, "transpose")
    for _ in range(10):
        phantom.press(LOADS_JOINT_2_ALONE, 2.5 * DEPTH_M)
    windings_c = phantom.run.truth()["winding_c"]
    assert windings_c[1] - windings_c[2] > 5.0, windings_c
    errors_deg = phantom.force_errors_deg(DEPTH_M)
    assert np.abs(errors_deg).max() < 0.5, errors_deg


def test_brushes_and_friction_spoil_the_direction_by_a_few_degrees_at_most() -> None:
    errors_deg = ClampedPhantom({}, "transpose").force_errors_deg(2.5e-3)
    # 10 % between two joints' stiffness turn the force by up to 4.7°, friction adds 0.04 N in 6 N.
    assert np.abs(errors_deg).max() < 5.5, errors_deg
    assert np.abs(errors_deg).max() > 1.0, "a twin without imperfections hides what the law must stand"
