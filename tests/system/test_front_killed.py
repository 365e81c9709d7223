"""kill -9 of the front while a wall is touched."""

from __future__ import annotations

import numpy as np
import pytest

from hapticd import _core
from hapticd.record import record_dtype
from tests.system.conftest import StartDaemon
from tests.system.daemon_process import FLOOR, UNDER_FLOOR, DaemonProcess, wait_until
from tests.system.tick_log import Ticks

pytestmark = pytest.mark.system

HEARTBEAT_S = 0.5
FADE_S = 0.1
HEARTBEAT_INTERVAL_S = 0.1
SLEW_N_PER_TICK = 4.0
FAULT = 4


def ticks_after_kill(daemon: DaemonProcess) -> Ticks:
    """The ticks of the PHANTOM from the kill of the front until it is in fault and at rest."""
    region = _core.Front(str(daemon.region("phantom")), observe=True)
    try:
        head = region.head()
        daemon.kill_front()
        wait_until(lambda: newest(region)["state"] == FAULT and newest(region)["gain"] == 0.0, "the fade")
        data, _, lost = region.read(head, 10_000)
        assert lost == 0
    finally:
        region.close()
    return np.frombuffer(data, record_dtype())


def newest(region: _core.Front) -> np.void:
    """The newest tick in a region."""
    record: np.void = np.frombuffer(region.latest(), record_dtype())[0]
    return record


def test_servo_fades_to_zero_within_the_watchdog_time_when_the_front_dies_in_contact(
    start_daemon: StartDaemon,
) -> None:
    daemon = start_daemon()
    daemon.press("phantom", FLOOR, UNDER_FLOOR)
    ticks = ticks_after_kill(daemon)
    live = np.linalg.norm(ticks["motor_torque_nm"], axis=1) > 0.0
    assert live[0], "the wall pushed when the front died"
    last_s = (ticks["t_mono_ns"][live][-1] - ticks["t_mono_ns"][0]) * 1e-9
    assert last_s <= HEARTBEAT_S + FADE_S + HEARTBEAT_INTERVAL_S
    steps_n = np.linalg.norm(np.diff(ticks["tip_force_command_n"], axis=0), axis=1)
    assert steps_n.max() <= SLEW_N_PER_TICK, "the fade stepped the force"
    assert np.all(ticks["motor_v"][-1] == 0.0)


def test_orphaned_servo_leaves_and_a_new_front_finds_the_device_disabled(start_daemon: StartDaemon) -> None:
    daemon = start_daemon()
    daemon.press("phantom", FLOOR, UNDER_FLOOR)
    daemon.kill_front()
    daemon.start()
    device = daemon.device("phantom")
    assert device["state"] in {"disabled", "fault"}
    assert device["walls"] == 1, "the scene was kept"
