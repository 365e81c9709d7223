"""The plant alone, as an emulated board drives it: packed commands in, packed observations out."""

import json
import struct

import numpy as np
import pytest

from hapticd import _core
from hapticd.model import load_model

COMMAND = struct.Struct("<10d")
OBSERVATION = struct.Struct("<QQ3q3dd3dQ")
OFF = COMMAND.pack(*[0.0] * 10)


def plant(model: str) -> _core.Plant:
    loaded = load_model(model)
    return _core.Plant(loaded.device_json, loaded.twin_json, 1000.0, 1)


def test_an_observation_has_the_layout_of_the_driver_protocol() -> None:
    hhd = plant("hhd")
    hhd.step(OFF)
    seq, t_ns, c1, c2, c3, *rest = OBSERVATION.unpack(hhd.step(OFF))
    joints = json.loads(load_model("hhd").device_json)["joints"]
    assert (seq, t_ns, c3) == (2, 1_000_000, 0)
    counts = np.array(joints["home_rad"][:2]) * joints["counts_per_rad"][:2]
    assert np.abs(np.array([c1, c2]) - counts).max() <= 1
    assert rest[-1] & 1, "the force sensor is present"


def test_a_command_moves_what_it_names() -> None:
    hhd = plant("hhd")
    push = COMMAND.pack(1.0, 0, 0, 0, 3.0, 0, 0, 0, 0, 0)
    for _ in range(100):
        hhd.step(push)
    assert hhd.truth()["joint_velocity_rad_per_s"][0] > 0.5
    assert hhd.truth()["motor_torque_nm"][0] == pytest.approx(3.0)


@pytest.mark.parametrize("buffer", [bytes, bytearray, memoryview])
def test_any_buffer_of_bytes_is_a_command(buffer: type) -> None:
    assert len(plant("phantom-1.0").step(buffer(OFF))) == OBSERVATION.size


def test_a_command_of_another_length_is_refused() -> None:
    with pytest.raises(ValueError, match="80 bytes"):
        plant("hhd").step(b"\0" * 79)


def test_a_hand_script_that_makes_no_sense_is_refused() -> None:
    with pytest.raises(ValueError, match="no sense"):
        plant("hhd").hand('{"type": "push", "direction": [0, 0, 0], "force_n": 1}')
    with pytest.raises(ValueError, match="wave"):
        plant("hhd").hand('{"type": "wave"}')
