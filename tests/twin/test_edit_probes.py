"""What other haptics libraries get wrong: a tip held still by a clamp while a wall around it is edited.

A spring of 1000 N/m, the tip 1 mm inside unless said otherwise.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd import _core
from hapticd.flat_wall import flat_plane
from hapticd.twin import TwinRun
from tests.twin.stirred_wall import AXIS, STEP_MAX_N

SPRING = {"type": "spring", "stiffness_n_per_m": 1000.0, "damping_n_s_per_m": 0.0}
MODELS = ["phantom-1.0", "hhd"]
FADE_S = 0.2
FORCE_MAX_N = {"phantom-1.0": 8.5, "hhd": 105.0}
IDEAL: Mapping[str, Mapping[str, Any]] = {
    "phantom-1.0": {"twin.winding.brush_ripple": 0.0, "twin.friction.coulomb_nm": [0.0, 0.0, 0.0]},
    "hhd": {"twin.sensor.bias_n": [0.0, 0.0, 0.0]},
}
"""Without what would hide a tenth of a newton."""


class HeldTip:
    """An enabled device whose tip a clamp holds where it is."""

    def __init__(self, model: str) -> None:
        self.twin = TwinRun(model, overrides=IDEAL[model])
        self.up = np.eye(3)[AXIS[model]]
        self.tip = self.twin.truth()["tip_position_m"]
        self.twin.hand({"type": "clamp", "position_m": self.tip.tolist()})
        self.twin.enable()
        self.twin.run(0.5)

    def wall(self, depth_m: float, law: Mapping[str, Any] = SPRING) -> dict[str, Any]:
        """A plane with the tip so deep behind it; motors alone render it, whose force is known."""
        surface_m = float(self.up @ self.tip) + depth_m
        return flat_plane(self.up.tolist(), surface_m, law, brake=False)

    def render(self, *walls: Mapping[str, Any], duration_s: float = 0.5) -> NDArray[Any]:
        """Records after the scene was replaced, with the force along the wall's normal."""
        self.twin.scene({"walls": list(walls), "fade_s": FADE_S})
        return self.twin.run(duration_s)

    def force_n(self, records: NDArray[Any]) -> NDArray[Any]:
        """Commanded force along the wall's normal, (ticks,)."""
        return np.asarray(records["tip_force_command_n"] @ self.up)


def steps_n(force_n: NDArray[Any]) -> float:
    """Largest change from one tick to the next."""
    return float(np.abs(np.diff(force_n)).max())


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("before_m", "after_m", "stiffness_n_per_m"),
    [(0.001, 0.003, 1000.0), (0.001, 0.001, 3000.0), (-0.001, 0.004, 1000.0)],
    ids=["moved 2 mm towards the hand", "stiffness × 3", "put around a tip 4 mm inside"],
)
def test_edit_of_a_touched_wall_fades_and_the_wall_is_kept(
    model: str, before_m: float, after_m: float, stiffness_n_per_m: float
) -> None:
    held = HeldTip(model)
    before = held.force_n(held.render(held.wall(before_m)))
    records = held.render(held.wall(after_m, SPRING | {"stiffness_n_per_m": stiffness_n_per_m}))
    after = held.force_n(records)
    # A spring drive gives k_c at most.
    granted_n_per_m = min(stiffness_n_per_m, float(records["stiffness_n_per_m"][-1]))
    assert before[-1] == pytest.approx(max(before_m, 0.0) * 1000.0, abs=0.1)
    assert after[-1] == pytest.approx(after_m * granted_n_per_m, abs=0.15)
    # Two hundred ticks share the change; no other library spreads it over more than one.
    assert steps_n(np.concatenate([before[-5:], after])) < 0.15


@pytest.mark.parametrize("model", MODELS)
def test_wall_switched_on_inside_it_is_felt_without_a_step(model: str) -> None:
    held = HeldTip(model)
    free = held.force_n(held.render())
    inside = held.force_n(held.render(held.wall(0.004)))
    assert np.abs(free[-1]) < 0.01
    assert inside[-1] == pytest.approx(4.0, abs=0.15)
    assert steps_n(np.concatenate([free[-5:], inside])) < 0.15


@pytest.mark.parametrize("model", MODELS)
def test_absurd_stiffness_never_sends_more_than_the_device_bears(model: str) -> None:
    held = HeldTip(model)
    records = held.render(held.wall(0.005, SPRING | {"stiffness_n_per_m": 1e6}))
    size_n = np.linalg.norm(records["tip_force_command_n"], axis=1)
    assert size_n.max() <= FORCE_MAX_N[model] * 1.001
    assert size_n[-1] > 0.9 * FORCE_MAX_N[model]
    step_n = np.linalg.norm(np.diff(records["tip_force_n"], axis=0), axis=1).max()
    assert step_n <= STEP_MAX_N[model] * 1.001


@pytest.mark.parametrize("model", MODELS)
def test_tip_past_the_middle_of_a_thin_wall_is_not_pushed_out_of_its_back(model: str) -> None:
    held = HeldTip(model)
    free_m = float(held.up @ held.tip)
    for depth_m in (0.00049, 0.00051):
        center = held.tip + (depth_m - 0.0005) * held.up
        thin = held.wall(0.0) | {
            "shape": {
                "type": "box",
                "center_m": center.tolist(),
                "axes": np.eye(3).tolist(),
                "half_m": [0.0005 if axis == AXIS[model] else 0.05 for axis in range(3)],
                "hollow": False,
            }
        }
        held.twin.hand({"type": "clamp", "position_m": (held.tip + 0.002 * held.up).tolist()})
        held.render(thin, duration_s=0.8)
        held.twin.hand({"type": "clamp", "position_m": held.tip.tolist()})
        records = held.twin.run(0.8)
        assert float(held.up @ records["tip_position_m"][-1]) == pytest.approx(free_m, abs=1e-4)
        assert held.force_n(records)[-1] == pytest.approx(1000.0 * depth_m, abs=0.1)


@pytest.mark.parametrize("model", MODELS)
def test_observation_that_is_not_finite_stops_the_device_and_sends_zero(model: str) -> None:
    held = HeldTip(model)
    held.render(held.wall(0.001))
    held.twin.inject({"type": "not_finite", "duration_s": 0.001})
    records = held.twin.run(0.3)
    assert np.isfinite(records["tip_force_command_n"]).all()
    assert not records["tip_force_command_n"][-1].any()
    bit = [entry["slug"] for entry in _core.fault_table()].index("observation-not-finite")
    assert int(records["faults"][-1]) >> bit & 1
