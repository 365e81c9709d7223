"""Bookkeeping of the applied torque against fine integration."""

import numpy as np
import pytest

from hapticd._core import Ledger
from tests.oracle.passivity import Lag

PERIOD_S = 0.001


@pytest.mark.parametrize("lag_s", [1e-4, 5e-4, 2.2e-3, 0.05])
def test_energy_of_measured_torque_is_the_integral_over_the_lag(lag_s: float) -> None:
    rng = np.random.default_rng(1)
    lag = Lag(np.full(3, lag_s), PERIOD_S)
    retain, ledger = np.exp(-PERIOD_S / lag.lag_s), Ledger(PERIOD_S)
    for _ in range(200):
        before_nm, step_rad = lag.torque_nm, rng.normal(0, 1e-3, 3)
        lag.live(rng.normal(0, 5, 3), step_rad)
        ledger.advance(before_nm, lag.torque_nm, retain, True)
        assert ledger.book(step_rad) == pytest.approx(lag.energy_j, abs=1e-7)


def test_modelled_torque_acts_a_tick_after_it_was_sent() -> None:
    rng = np.random.default_rng(2)
    lag = Lag(np.full(3, 5e-4), PERIOD_S)
    retain, ledger = np.exp(-PERIOD_S / lag.lag_s), Ledger(PERIOD_S)
    waiting_nm, model_nm = np.zeros(3), np.zeros(3)
    for _ in range(200):
        command_nm, step_rad = rng.normal(0, 5, 3), rng.normal(0, 1e-3, 3)
        lag.live(waiting_nm, step_rad)
        settled_nm = command_nm + retain * (model_nm - command_nm)
        ledger.advance(model_nm, settled_nm, retain, False)
        assert ledger.book(step_rad) == pytest.approx(lag.energy_j, abs=1e-7)
        waiting_nm, model_nm = command_nm, settled_nm


def test_lost_frames_are_booked_with_the_mean_of_their_periods() -> None:
    ledger = Ledger(PERIOD_S)
    for torque_nm in (1.0, 2.0, 6.0):
        ledger.advance([torque_nm] * 3, [torque_nm] * 3, [0.5] * 3, True)
    assert ledger.book([0.01, 0.0, 0.0]) == pytest.approx(-0.03)
