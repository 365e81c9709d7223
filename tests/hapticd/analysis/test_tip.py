"""The tip's mass, friction and resolution against numbers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from hapticd.analysis.device_loop import device_loop
from hapticd.analysis.tip import poses, tip_at, worst_tip
from hapticd.model import Model, load_model

HHD, PHANTOM = load_model("hhd"), load_model("phantom-1.0")
HHD_HOME = (np.radians(30.0), np.radians(150.0), 0.0)


def test_hhd_tip_at_home_is_that_of_the_physics_notes() -> None:
    """§4.2 at (0, 200) mm with N_g = 14: 1.2 kg and 3 N·s/m, both radially; the encoders give 9 µm."""
    tip = tip_at(HHD, HHD_HOME)
    assert tip.mass_kg == pytest.approx(1.2, abs=0.05)
    assert tip.viscous_n_s_per_m == pytest.approx(3.0, abs=0.01)
    assert tip.quantum_m == pytest.approx(9e-6, rel=0.01)


def test_dry_friction_is_the_least_that_any_direction_of_motion_meets() -> None:
    """Σ f|q̇| per speed over a fine circle of directions; bearings 1 N·m and drag 0.4 N·m."""
    q1, q2, _ = HHD_HOME
    jacobian = 0.2 * np.array([[-np.sin(q1), -np.sin(q2)], [np.cos(q1), np.cos(q2)]])
    angle = np.linspace(0, 2 * np.pi, 100_000)
    speeds = np.linalg.inv(jacobian) @ np.stack([np.cos(angle), np.sin(angle)])
    assert tip_at(HHD, HHD_HOME).coulomb_n == pytest.approx(
        float(1.4 * np.abs(speeds).sum(0).min()), rel=1e-3
    )


def test_phantom_tip_is_light_and_as_fine_as_its_vendor_says() -> None:
    """§1.2: 45…140 g where the links are level; §1: about 0.03 mm, times the reach of the first joint."""
    tip = tip_at(PHANTOM, (0.0, 0.0, 0.0))
    assert 0.035 < tip.mass_kg < 0.05
    assert tip.quantum_m == pytest.approx(0.14 / 4563.3, rel=0.01)
    assert tip.coulomb_n == pytest.approx(0.04, rel=0.01)


@pytest.mark.parametrize("model", [HHD, PHANTOM], ids=["hhd", "phantom"])
def test_worst_tip_bounds_every_pose(model: Model) -> None:
    worst = worst_tip(model)
    for q in list(poses(model))[::17]:
        tip = tip_at(model, q)
        assert worst.mass_kg <= tip.mass_kg
        assert worst.viscous_n_s_per_m <= tip.viscous_n_s_per_m
        assert worst.coulomb_n <= tip.coulomb_n
        assert worst.quantum_m >= tip.quantum_m


def test_a_singular_pose_is_refused() -> None:
    with pytest.raises(ValueError, match="singular"):
        tip_at(HHD, (1.3, 1.3, 0.0))


def test_k_hf_of_the_phantom_is_the_spring_of_its_inductance() -> None:
    """§2.2: k_T²/L is 112.7 N·m/rad at joints 2 and 3; level links carry it to 112.7/l²."""
    coupling = device_loop(PHANTOM, 1000.0, q=(0.0, 0.0, 0.0)).coupling
    assert coupling.series_n_per_m == pytest.approx(112.7 / 0.14**2, rel=0.01)
    assert coupling.stiffness_n_per_m == pytest.approx(0.6 * coupling.series_n_per_m, rel=1e-3)
