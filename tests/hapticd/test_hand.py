"""Hand scripts and injections: the core takes what the models let through."""

import json
from typing import Any

import pytest
from pydantic import ValidationError

from hapticd import _core
from hapticd.hand import HAND_SCRIPT, flat_script
from hapticd.injection import INJECTION
from hapticd.model import load_model

SCRIPTS: list[dict[str, Any]] = [
    {"type": "free"},
    {"type": "hold"},
    {"type": "hold", "stiff": True},
    {"type": "follow", "target_m": [0.0, 0.2]},
    {"type": "push", "direction": [0, -1], "force_n": 5.0},
    {"type": "stroke", "center_m": [0, 0.2], "axis": [1, 0], "amplitude_m": 0.02, "frequency_hz": 1.0},
    {"type": "minimum_jerk", "from_m": [0, 0.2], "to_m": [0.02, 0.2], "duration_s": 0.5},
    {"type": "clamp", "position_m": [0, 0.2]},
]

INJECTIONS: list[dict[str, Any]] = [
    *(
        {"type": kind, "duration_s": 0.1}
        for kind in ("unplug", "silence", "not_finite", "encoder_jump", "estop_input", "sensor_saturated")
    ),
    {"type": "amplifier_fault", "duration_s": 0.1},
    {"type": "drop_frames", "fraction": 0.5, "duration_s": 0.1},
]


@pytest.fixture
def simulation() -> _core.Simulation:
    model = load_model("hhd")
    return _core.Simulation(model.device_json, model.twin_json, 1000.0, 1)


@pytest.mark.parametrize("document", SCRIPTS, ids=lambda document: document["type"])
def test_core_takes_every_script_the_model_lets_through(
    document: dict[str, Any], simulation: _core.Simulation
) -> None:
    script = flat_script(HAND_SCRIPT.validate_python(document), dof=2)
    assert simulation.request(json.dumps({"type": "hand", "script": script})) == 0


@pytest.mark.parametrize("document", INJECTIONS, ids=lambda document: document["type"])
def test_core_takes_every_injection_the_model_lets_through(
    document: dict[str, Any], simulation: _core.Simulation
) -> None:
    injection = INJECTION.validate_python(document).model_dump()
    assert simulation.request(json.dumps({"type": "inject", "injection": injection})) == 0


@pytest.mark.parametrize(
    "document",
    [
        {"type": "wave"},
        {"target_m": [0.0, 0.2], "speed": 1},
        {"type": "push", "direction": [0, 0], "force_n": 5.0},
        {"type": "push", "direction": [0, -1], "force_n": -5.0},
        {"type": "stroke", "center_m": [0, 0.2], "axis": [0, 0], "amplitude_m": 0.02, "frequency_hz": 1.0},
        {"type": "follow", "target_m": [0.0, float("nan")]},
        {"type": "minimum_jerk", "from_m": [0, 0.2], "to_m": [0, 0.2], "duration_s": 0.0},
        {},
    ],
)
def test_script_that_makes_no_sense_is_refused(document: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        HAND_SCRIPT.validate_python(document)


def test_point_alone_is_followed() -> None:
    script = HAND_SCRIPT.validate_python({"target_m": [0.0, 0.2]})
    assert flat_script(script, dof=2) == {"type": "follow", "target_m": [0.0, 0.2, 0.0]}
