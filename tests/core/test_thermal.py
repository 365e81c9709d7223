"""Thermal model and I²t budget of the core against exact solutions."""

import json

import numpy as np
import pytest

from hapticd._core import Budget, Thermal
from tests.oracle import thermal
from tests.oracle.devices import HHD, PHANTOM, device, device_json

DRIVE = device(PHANTOM)["drive"]
PERIOD_S = 0.1


def motor() -> thermal.Motor:
    values = {key: value for key, value in DRIVE["thermal"].items() if key != "winding_max_c"}
    return thermal.Motor(**values)


@pytest.mark.parametrize("current_a", [0.5, 1.24, 4.0])
@pytest.mark.parametrize("time_s", [3.0, 30.0, 600.0])
def test_winding_temperature_follows_the_exact_two_node_solution(current_a: float, time_s: float) -> None:
    core = Thermal(device_json(PHANTOM), PERIOD_S)
    winding_c, loss_ws = [25.0], 0.0
    for _ in range(round(time_s / PERIOD_S)):
        # Constant loss: the current is lowered as the resistance rises.
        resistance = thermal.resistance_ohm(DRIVE["r_25_ohm"][0], winding_c[0])
        constant_a = current_a * np.sqrt(DRIVE["r_25_ohm"][0] / resistance)
        loss_ws += constant_a**2 * resistance * PERIOD_S
        winding_c, _ = core.step([constant_a, 0.0, 0.0])
    exact = motor().temperatures_c(loss_ws / time_s, time_s)[0]
    # The nodes are stepped apart: right to some percent of the rise on the way, exact at both ends.
    assert winding_c[0] - 25 == pytest.approx(exact - 25, rel=0.06)
    assert winding_c[1:] == [25.0, 25.0]


def test_residual_resistance_is_that_of_the_temperature() -> None:
    core = Thermal(device_json(PHANTOM), PERIOD_S)
    for current_a in np.linspace(0, 3, 200):
        winding_c, residual_ohm = core.step([current_a, 0.5, 0.0])
        for joint in range(3):
            resistance = thermal.resistance_ohm(DRIVE["r_25_ohm"][joint], winding_c[joint])
            assert residual_ohm[joint] == pytest.approx(resistance - DRIVE["r_hat_ohm"][joint])


def test_cold_winding_keeps_a_positive_residual() -> None:
    cold = device(PHANTOM)
    cold["drive"]["thermal"]["ambient_c"] = -20.0
    _, residual_ohm = Thermal(json.dumps(cold), PERIOD_S).step([0.0, 0.0, 0.0])
    assert residual_ohm == pytest.approx([0.01 * 2.18] * 3)


def test_torque_drives_have_no_thermal_model() -> None:
    with pytest.raises(ValueError, match="torque drives"):
        Thermal(device_json(HHD), PERIOD_S)


@pytest.mark.parametrize("load", [0.4, 1.24, 3.0, 7.5])
def test_budget_follows_the_exact_solution(load: float) -> None:
    core = Budget(peak=[7.5] * 3, continuous=[1.24] * 3, peak_time_s=1.5, period_s=PERIOD_S)
    for step in range(1, 60):
        used, limit = core.step([load, -load, 0.0])
        exact = thermal.i2t_used(load, 1.24, 7.5, 1.5, step * PERIOD_S)
        assert used == pytest.approx([exact, exact, 0.0], rel=1e-9)
        assert limit[0] == pytest.approx(np.interp(exact, [0.8, 1.0], [7.5, 1.24]), rel=1e-9)
