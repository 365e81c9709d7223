"""Options as people write them."""

from __future__ import annotations

from typing import Any

import pytest

from hapticd_drivers.error import OptionError
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.hapticd_io.options import Options
from hapticd_drivers.hapticd_io.protocol import UNIT_MILLIAMPERE, UNIT_VOLT
from tests.drivers.device_rig import device_json

HHD = Needs.of(device_json("hhd"))
PHANTOM = Needs.of(device_json("phantom-1.0"))
GOOD: dict[str, Any] = {"port": "/dev/ttyACM0", "motor_nm_per_v": [2.3, 2.3], "brake_nm_per_a": [12, 12]}


def test_needs_are_those_of_the_model() -> None:
    assert (HHD.axes, HHD.spring_drive, HHD.motor_max, HHD.brake_max_nm) == (
        2,
        False,
        (22.2, 22.2),
        (10.0, 10.0),
    )
    assert (PHANTOM.axes, PHANTOM.spring_drive, PHANTOM.motor_max) == (3, True, (24.0, 24.0, 24.0))
    assert PHANTOM.brake_max_nm == ()


def test_little_has_to_be_said() -> None:
    options = Options.parse(GOOD, HHD)
    assert (options.encoders, options.motors.channels) == ((0, 1), (0, 1))
    assert (options.motors.unit, options.motors.gains) == (UNIT_VOLT, (2.3, 2.3))
    assert options.brakes is not None
    assert (options.brakes.channels, options.brakes.unit) == ((2, 3), UNIT_MILLIAMPERE)
    assert (options.watchdog_s, options.reply_timeout_s, options.pacing) == (0.05, 0.0006, "device")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"port": None}, "port is missing"),
        ({"port": 3}, "port must be a text"),
        ({"bauds": 9600}, "unknown option bauds: did you mean baud"),
        ({"baud": "fast"}, "baud must be a number from 9600"),
        ({"baud": True}, "baud must be a number"),
        ({"watchdog_s": 0}, "watchdog_s must be a number from 0.001 to 6.5"),
        ({"watchdog_s": float("nan")}, "watchdog_s must be"),
        ({"reply_timeout_s": 0.002}, "reply_timeout_s must be a number from 0 to 0.001"),
        ({"pacing": "both"}, "pacing must be one of device, host"),
        ({"uid": "0011"}, "uid must be 16 hexadecimal digits"),
        ({"uid": 11}, "uid must be 16 hexadecimal digits"),
        ({"encoders": [0]}, "encoders must be 2 different channels from 0 to 3"),
        ({"encoders": [1, 1]}, "encoders must be 2 different channels"),
        ({"encoders": [0, 4]}, "encoders must be 2 different channels"),
        ({"encoders": [0, 1.5]}, "encoders must be a list of channel numbers"),
        ({"motor_nm_per_v": None}, "give exactly one of motor_nm_per_v, motor_nm_per_a"),
        ({"motor_nm_per_a": [1, 1]}, "give exactly one of motor_nm_per_v, motor_nm_per_a"),
        ({"motor_v_per_v": [1, 1]}, "unknown option motor_v_per_v"),
        ({"motor_nm_per_v": [2.3]}, "motor_nm_per_v must be a list of 2 finite numbers"),
        ({"motor_nm_per_v": [2.3, 0]}, "motor_nm_per_v: a gain of zero drives nothing"),
        ({"brake_nm_per_a": ["a", 1]}, "brake_nm_per_a must be a list of 2 finite numbers"),
        ({"force_inputs": [0, 1]}, "force_n_per_v is missing"),
        ({"force_inputs": []}, "force_inputs must be different channels from 0 to 7"),
        ({"force_inputs": [0, 1], "force_n_per_v": [[1, 0]]}, "force_n_per_v must have 2 rows"),
        ({"force_inputs": [0, 1], "force_n_per_v": [[1], [0]]}, "force_n_per_v must be a list of 2"),
        ({"force_n_per_v": [[1], [0]]}, "unknown option force_n_per_v"),
        ({"current_inputs": [0, 1]}, "current_a_per_v is missing"),
    ],
)
def test_a_wrong_option_is_refused_by_name(change: dict[str, Any], words: str) -> None:
    options = {key: value for key, value in (GOOD | change).items() if value is not None}
    with pytest.raises(OptionError, match=words):
        Options.parse(options, HHD)


def test_a_device_without_brakes_takes_no_brake_option() -> None:
    good = {"port": "x", "motor_v_per_v": [1, 1, -1]}
    assert Options.parse(good, PHANTOM).brakes is None
    with pytest.raises(OptionError, match="unknown option brake_nm_per_a"):
        Options.parse(good | {"brake_nm_per_a": [1, 1]}, PHANTOM)
