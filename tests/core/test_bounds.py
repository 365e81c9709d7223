"""The bounding layer against a search for the largest torque that obeys every limit."""

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd._core import Kinematics, bound_brake, bound_motor, singularity_fade
from tests.oracle.bounds import Limits
from tests.oracle.devices import HHD, PHANTOM, device, device_json, poses

PERIOD_S = 0.001
LIMITS = {
    name: (device(name)["limits"]["tip_force_n"], device(name)["limits"]["tip_slew_n_per_s"])
    for name in (PHANTOM, HHD)
}


def random_limits(name: str, jacobian_inverse: NDArray[np.float64], rng: np.random.Generator) -> Limits:
    force_n, slew_n_per_s = LIMITS[name]
    return Limits(
        force_n=force_n,
        slew_n=slew_n_per_s * PERIOD_S,
        jacobian_inverse=jacobian_inverse,
        peak_nm=rng.uniform(0.2, 3, 3),
        retain=rng.uniform(0, 1, 3),
        emf_v=rng.uniform(-5, 5, 3),
        v_per_nm=rng.uniform(0.5, 10, 3),
        max_v=np.full(3, 24.0),
    )


@pytest.mark.parametrize("name", [PHANTOM, HHD])
def test_bounded_torque_is_the_largest_that_every_limit_allows(name: str) -> None:
    rng, model = np.random.default_rng(1), device_json(name)
    kinematics = Kinematics(model)
    for q in poses(name, 150, seed=1):
        limits = random_limits(name, np.array(kinematics.jacobian_inverse(q)), rng)
        asked_nm, present_nm = rng.normal(0, 4, 3), rng.normal(0, 1, 3)
        fade = rng.uniform(0, 1)
        bounded, _ = bound_motor(
            model,
            asked_nm,
            period_s=PERIOD_S,
            fade=fade,
            jacobian_inverse=limits.jacobian_inverse,
            peak_nm=limits.peak_nm,
            present_nm=present_nm,
            retain=limits.retain,
            supply=np.array([limits.emf_v, limits.v_per_nm, limits.max_v]),
        )
        assert bounded == pytest.approx(limits.bounded(fade * asked_nm, present_nm), abs=1e-9)


def test_torque_drive_has_no_supply_to_limit() -> None:
    asked_nm = np.array([5.0, -3.0, 0.0])
    bounded, acted = bound_motor(
        device_json(HHD),
        asked_nm,
        period_s=PERIOD_S,
        fade=1.0,
        jacobian_inverse=np.eye(3),
        peak_nm=[22.2, 22.2, 0.0],
        present_nm=[0.0] * 3,
        retain=[0.1] * 3,
    )
    assert bounded == pytest.approx(asked_nm)
    assert acted == 0


def test_brake_is_the_largest_torque_its_bounds_allow() -> None:
    rng = np.random.default_rng(2)
    for _ in range(2000):
        asked, before, wanted, qd = rng.uniform([0, 0, -5, -0.1], [15, 10, 5, 0.1])
        bounded = bound_brake(
            asked_nm=asked,
            before_nm=before,
            wanted_nm=wanted,
            qd=qd,
            max_nm=10.0,
            rise_nm=2.0,
            omega_off=0.02,
        )
        dissipates = abs(qd) <= 0.02 or wanted * qd < 0
        assert bounded == pytest.approx(min(asked, 10.0, before + 2.0) if dissipates else 0.0)


def test_singularity_fade_is_smooth_and_rises() -> None:
    margins = np.linspace(0, 0.4, 4001)
    fades = np.array([singularity_fade(margin, 0.3) for margin in margins])
    slopes = np.gradient(fades, margins)
    assert (slopes >= 0).all()
    assert np.abs(np.diff(slopes)).max() < 0.05
    assert (fades[margins < 0.15] == 0).all()
    assert (fades[margins > 0.3001] == 1).all()
