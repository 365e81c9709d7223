"""kill -9 of one servo while its wall is touched."""

from __future__ import annotations

import time

import pytest

from tests.system.conftest import StartDaemon
from tests.system.daemon_process import FLOOR, UNDER_FLOOR, DaemonProcess, wait_until

pytestmark = pytest.mark.system

OFFLINE_WITHIN_S = 1.0
HEARTBEAT_FAULTS = {"front-lost", "deadline-missed"}


@pytest.fixture
def daemon(start_daemon: StartDaemon) -> DaemonProcess:
    """Both devices enabled, the PHANTOM pushing back."""
    daemon = start_daemon()
    daemon.put("hhd/state", {"desired": "enabled"})
    daemon.press("phantom", FLOOR, UNDER_FLOOR)
    return daemon


def test_device_is_offline_within_a_second_and_comes_back_disabled_with_its_scene(
    daemon: DaemonProcess,
) -> None:
    pid = daemon.servo_pid("phantom")
    daemon.kill_servo("phantom")
    killed_s = time.monotonic()
    wait_until(lambda: daemon.device("phantom")["state"] == "offline", "offline", OFFLINE_WITHIN_S)
    assert time.monotonic() - killed_s <= OFFLINE_WITHIN_S
    wait_until(lambda: daemon.device("phantom")["state"] == "disabled", "the device to come back")
    device = daemon.device("phantom")
    assert device["health"]["pid"] != pid
    assert device["scene_in_force"]
    assert device["walls"] == 1
    assert all(volts == 0.0 for volts in device["tip_force_n"])


def test_other_device_and_api_do_not_notice(daemon: DaemonProcess) -> None:
    before = daemon.device("hhd")
    daemon.kill_servo("phantom")
    wait_until(lambda: daemon.device("phantom")["state"] == "offline", "offline", OFFLINE_WITHIN_S)
    assert daemon.http.get("/livez").status_code == 200
    wait_until(lambda: daemon.device("phantom")["state"] == "disabled", "the device to come back")
    after = daemon.device("hhd")
    assert after["state"] == "enabled"
    assert after["health"]["pid"] == before["health"]["pid"]
    assert after["tick"] > before["tick"]
    assert not after["faults"]
