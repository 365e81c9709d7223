"""The closed loop of controller and twin: repeatable, safe to edit, honest about faults."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hapticd import _core
from hapticd.flat_wall import rigid_plane
from hapticd.twin import Refused, TwinRun

MODELS = ["phantom-1.0", "hhd"]


def wall_below(run: TwinRun, axis: int, depth_m: float) -> dict[str, Any]:
    """A rigid wall whose surface is ``depth_m`` above the tip along an axis."""
    n = np.eye(3)[axis]
    surface_m = float(n @ run.truth()["tip_position_m"]) + depth_m
    return {"walls": [rigid_plane(n.tolist(), surface_m)], "fade_s": 0.1}


def eventful(model: str, seed: int) -> NDArray[Any]:
    """Records of a run with contact, an edit, lost frames and a disabling."""
    run = TwinRun(model, seed=seed)
    run.scene(wall_below(run, 1, -0.005))
    run.enable()
    run.hand({"type": "push", "direction": [0.0, -1.0, 0.0], "force_n": 3.0})
    parts = [run.run(0.5)]
    run.inject({"type": "drop_frames", "fraction": 0.2, "duration_s": 0.2})
    run.scene(wall_below(run, 1, 0.001))
    parts.append(run.run(0.4))
    run.disable()
    parts.append(run.run(0.3))
    return np.concatenate(parts)


@pytest.mark.parametrize("model", MODELS)
def test_one_seed_repeats_a_run_bit_by_bit(model: str) -> None:
    assert eventful(model, 3).tobytes() == eventful(model, 3).tobytes()


@pytest.mark.parametrize("model", MODELS)
def test_another_seed_is_another_run(model: str) -> None:
    assert eventful(model, 3).tobytes() != eventful(model, 4).tobytes()


@pytest.mark.parametrize("model", MODELS)
def test_a_wall_put_around_the_tool_does_not_step_the_force(model: str) -> None:
    run = TwinRun(model)
    run.enable()
    run.hand({"type": "hold", "stiff": True})
    run.run(0.5)
    run.scene(wall_below(run, 1, 0.004) | {"fade_s": 0.0})
    records = run.run(0.5)
    force = np.linalg.norm(np.diff(records["tip_force_n"], axis=0), axis=1)
    limit_n = {"phantom-1.0": 4.0, "hhd": 60.0}[model]
    assert np.linalg.norm(records["tip_force_n"][-1]) > 0.5
    assert force.max() <= limit_n * 1.01


@pytest.mark.parametrize("model", MODELS)
def test_forces_are_gone_within_the_fade_after_disabling(model: str) -> None:
    run = TwinRun(model)
    run.scene(wall_below(run, 1, 0.004))
    run.enable()
    run.hand({"type": "hold", "stiff": True})
    assert np.linalg.norm(run.run(1.0)["tip_force_n"][-1]) > 0.5
    run.disable()
    after = run.run(0.4)
    assert not after["motor_v"][150:].any()
    assert not after["motor_torque_nm"][150:].any()


@pytest.mark.parametrize(
    ("injection", "fault"),
    [
        ({"type": "silence", "duration_s": 0.1}, "observation-missing"),
        ({"type": "encoder_jump", "duration_s": 0.1}, "encoder-jump"),
        ({"type": "not_finite", "duration_s": 0.1}, "observation-not-finite"),
        ({"type": "amplifier_fault", "duration_s": 0.1}, "amplifier"),
    ],
)
@pytest.mark.parametrize("model", MODELS)
def test_an_injected_fault_stops_the_device_by_its_name(
    model: str, injection: dict[str, Any], fault: str
) -> None:
    run = TwinRun(model)
    run.enable()
    run.run(0.5)
    run.inject(injection)
    last = run.run(0.05)[-1]
    bit = [entry["slug"] for entry in _core.fault_table()].index(fault)
    assert int(last["faults"]) >> bit & 1
    assert not last["motor_v"].any()
    assert not last["motor_torque_nm"].any()


@pytest.mark.parametrize("model", MODELS)
def test_an_unplugged_device_is_offline_and_returns_disabled(model: str) -> None:
    run = TwinRun(model)
    run.enable()
    run.run(0.2)
    run.inject({"type": "unplug", "duration_s": 0.1})
    assert run.run(0.05)[-1]["state"] == 0
    with pytest.raises(Refused, match="offline"):
        run.enable()
    run.run(0.2)
    run.acknowledge_faults()
    assert run.run(0.01)[-1]["state"] == 1


def test_records_tell_where_the_hand_is_and_how_it_pushes() -> None:
    run = TwinRun("phantom-1.0")
    run.hand({"type": "hold"})
    records = run.run(0.2)
    assert np.allclose(records["hand_position_m"][-1], run.truth()["hand_position_m"])
    assert np.allclose(records["tip_position_m"][-1], run.truth()["tip_position_m"], atol=5e-5)


def test_a_request_that_is_none_is_refused_with_the_reason() -> None:
    run = TwinRun("phantom-1.0")
    with pytest.raises(ValueError, match="target_m"):
        run.hand({"type": "follow"})
    with pytest.raises(ValueError, match="colour"):
        run.scene({"colour": "red"})
