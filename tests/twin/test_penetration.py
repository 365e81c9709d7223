"""How far a push sinks into the PHANTOM's walls: F / k_c, whatever the direction and the wall."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd.flat_wall import rigid_plane
from hapticd.twin import TwinRun
from tests.twin.clamped_phantom import IDEAL, normal

UP = np.array([0.0, 0.0, 1.0])


def pushed(n: NDArray[np.float64], force_n: float, *, eta: float = 0.0, **scene: Any) -> tuple[float, Any]:
    """True depth in a wall at the tip under a steady push against it, m, and the last record."""
    run = TwinRun("phantom-1.0", overrides=IDEAL)
    surface_m = float(n @ run.truth()["tip_position_m"])
    run.scene({**scene, "walls": [rigid_plane(n.tolist(), surface_m, eta=eta)]})
    run.enable()
    run.hand({"type": "push", "direction": (-n).tolist(), "force_n": force_n})
    last = run.run(3.0)[-1]
    return surface_m - float(n @ run.truth()["tip_position_m"]), last


@pytest.mark.parametrize("angle_deg", range(0, 360, 60))
@pytest.mark.parametrize("force_n", [3.0, 6.0])
def test_depth_is_force_over_k_c_within_two_percent(angle_deg: int, force_n: float) -> None:
    depth_m, last = pushed(normal(np.radians(angle_deg)), force_n)
    assert np.linalg.norm(last["hand_force_n"]) == pytest.approx(force_n, rel=0.01)
    # The smaller push is 1.4 mm deep; an encoder count is 31 µm at the tip.
    assert depth_m == pytest.approx(force_n / last["stiffness_n_per_m"], rel=0.02)


def test_depth_across_the_base_axis_with_its_other_ratio_is_the_same() -> None:
    sideways = np.array([0.0, 1.0, 0.0])
    depth_m, last = pushed(sideways, 4.0)
    assert depth_m == pytest.approx(4.0 / last["stiffness_n_per_m"], rel=0.02)


@pytest.mark.parametrize("eta", [0.25, 0.5, 0.75])
def test_eta_leaves_its_complement_of_the_stiffness(eta: float) -> None:
    depth_m, last = pushed(UP, 4.0, eta=eta)
    assert 4.0 / depth_m == pytest.approx((1 - eta) * last["stiffness_n_per_m"], rel=0.02)


def test_workspace_stiffness_is_below_the_pose_and_kept_in_the_wall() -> None:
    _, pose = pushed(UP, 4.0)
    depth_m, everywhere = pushed(UP, 4.0, stiffness="workspace")
    assert everywhere["stiffness_n_per_m"] < pose["stiffness_n_per_m"]
    assert depth_m == pytest.approx(4.0 / everywhere["stiffness_n_per_m"], rel=0.02)
