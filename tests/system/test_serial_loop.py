"""The HHD with its loop closed over real frames on a pseudo-terminal."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from hapticd.record import record_dtype
from tests.system.conftest import StartDaemon
from tests.system.daemon_process import DaemonProcess, wait_until
from tests.system.emulated_board import EmulatedBoard
from tests.system.tick_log import TickLog, Ticks, Values

pytestmark = pytest.mark.system

SECONDS = 60.0
CYCLE_S = 4.0
MISSING_TICKS = 200
STATUS_FRESH = 1 << 4

PATIENT = {"limits.missing_ticks": MISSING_TICKS}
"""A pseudo-terminal hands bytes over in a kernel worker without priority, which a busy machine holds up;

shared machines stand still for 60 ms at times.
"""

WALL = {
    "id": "back",
    "shape": {"type": "plane", "point_m": [0, 0.23], "normal": [0, -1]},
    "law": {"type": "motion", "eta": 0.0},
}
PUSH = {"type": "push", "direction": [0, 1, 0], "force_n": 20.0, "speed_m_per_s": 0.1}
BACK = {"type": "follow", "target_m": [0.0, 0.20, 0.0]}
SILENT_TICKS = 5
"""Ticks without a frame that end a device by default; only a starved board is silent for longer."""

RECOVERY_TICKS = 200

FELT_STEP_N = 5.0
"""Largest change that the hand may feel from one tick to the next: twice what the grip gives at 0.1 m/s."""


@pytest.fixture
def board(tmp_path: Path) -> Iterator[EmulatedBoard]:
    board = EmulatedBoard(tmp_path / "board").start()
    yield board
    board.kill()


def enabled(daemon: DaemonProcess) -> DaemonProcess:
    """The wall in place and the device enabled."""
    daemon.put("hhd/scene/walls/back", WALL)
    wait_until(lambda: enables(daemon), "the device to be enabled")
    return daemon


def enables(daemon: DaemonProcess) -> bool:
    """Enables the device, faults of a machine that stood still acknowledged."""
    for fault in daemon.device("hhd")["faults"]:
        daemon.http.delete(f"/api/v1/devices/hhd/faults/{fault['id']}")
    return daemon.http.put("/api/v1/devices/hhd/state", json={"desired": "enabled"}).is_success


def pushes_without_fault(daemon: DaemonProcess) -> bool:
    """Whether the enabled device pushes back; enables it anew where it is not."""
    if daemon.device("hhd")["faults"]:
        enables(daemon)
    return daemon.pushes("hhd") and not daemon.device("hhd")["faults"]


def pushed_and_released(board: EmulatedBoard, seconds: float) -> None:
    """Pushes the hand into the wall and takes it back, again and again."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        board.tell(hand=PUSH)
        time.sleep(CYCLE_S / 2)
        board.tell(hand=BACK)
        time.sleep(CYCLE_S / 2)


def forces_n(ticks: Ticks) -> Values:
    forces: Values = np.linalg.norm(ticks["tip_force_command_n"], axis=1)
    return forces


def test_wall_stays_rigid_and_force_never_steps_for_a_minute_over_real_bytes(
    board: EmulatedBoard, start_daemon: StartDaemon, capsys: pytest.CaptureFixture[str]
) -> None:
    daemon = enabled(start_daemon(board.device(overrides=PATIENT)))
    with TickLog(daemon.region("hhd")) as log:
        pushed_and_released(board, SECONDS)
    ticks = log.ticks
    device = daemon.device("hhd")
    assert device["state"] == "enabled", device["faults"]
    assert log.lost == 0
    judged = ticks[undisturbed(ticks)]
    steps_n = felt_steps_n(judged)
    with capsys.disabled():
        print(f"\n{report(ticks, judged, steps_n)}")
    assert steps_n.max() <= FELT_STEP_N
    assert forces_n(judged).max() > 15.0, "the wall was pushed"
    assert judged["contact_depth_m"].max() < 2.5e-3, "the wall gave way"
    released = judged[judged["contact_count"] == 0]
    assert len(released) > 1000
    assert np.abs(released["tip_force_demand_n"]).max() < 1e-9, "free space pushed"
    assert len(judged) > 0.5 * len(ticks), "the machine starved the board"


def felt_steps_n(ticks: Ticks) -> Values:
    """Change of the hand's force between frames that follow one another, 1 ms apart."""
    steps: Values = np.linalg.norm(np.diff(ticks["sensor_force_n"], axis=0), axis=1)
    following: Values = steps[np.diff(ticks["observation_seq"]) == 1]
    return following


def undisturbed(ticks: Ticks) -> Values:
    """Fresh ticks away from a long silence of the board, whose effect another test judges."""
    starved = (ticks["observation_missing"] > SILENT_TICKS).astype(int)
    nearby = np.convolve(starved, np.ones(RECOVERY_TICKS, dtype=int))[: len(ticks)]
    judged: Values = (nearby == 0) & (ticks["flags"] & STATUS_FRESH != 0)
    return judged


def report(ticks: Ticks, judged: Ticks, steps_n: Values) -> str:
    """The counts of the run, for the reader of the log."""
    late = int(np.sum(ticks["flags"] & STATUS_FRESH == 0))
    lost = int(ticks["observation_lost"][-1] - ticks["observation_lost"][0])
    return (
        f"HHD over a pseudo-terminal: {len(ticks)} ticks, {late} without a new frame, {lost} frames lost, "
        f"{int(ticks['missed_ticks'][-1] - ticks['missed_ticks'][0])} deadlines missed, "
        f"{len(judged)} judged, largest step of the felt force {steps_n.max():.2f} N, "
        f"deepest {1e3 * judged['contact_depth_m'].max():.2f} mm"
    )


def test_killed_board_is_a_named_fault_within_the_tick_budget_and_comes_back_disabled(
    board: EmulatedBoard, start_daemon: StartDaemon
) -> None:
    daemon = enabled(start_daemon(board.device(overrides=PATIENT)))
    board.tell(hand=PUSH)
    wait_until(lambda: pushes_without_fault(daemon), "contact")
    with TickLog(daemon.region("hhd")) as log:
        board.kill()
        wait_until(lambda: daemon.device("hhd")["faults"], "a fault")
        wait_until(lambda: daemon.device("hhd")["state"] == "offline", "the device to be offline")
    fault_in_time_with_outputs_at_zero(log.ticks)
    assert daemon.http.get("/livez").status_code == 200
    assert {fault["id"] for fault in daemon.device("hhd")["faults"]} <= {"device-lost", "observation-missing"}
    board.start()
    wait_until(lambda: daemon.device("hhd")["state"] == "disabled", "the device to come back")
    refused = daemon.http.put("/api/v1/devices/hhd/state", json={"desired": "enabled"})
    assert refused.status_code == 409, "a device that was lost waits for somebody to acknowledge it"


def fault_in_time_with_outputs_at_zero(ticks: Ticks) -> None:
    """From the last frame on: a fault within the budget, and no command after it."""
    assert ticks.dtype == record_dtype()
    faulty = int(np.argmax(ticks["faults"] != 0))
    last_fresh = int(np.flatnonzero(ticks["flags"][:faulty] & STATUS_FRESH)[-1])
    assert faulty - last_fresh <= MISSING_TICKS + 1
    assert np.all(forces_n(ticks[faulty:]) == 0.0)
    assert np.all(ticks["brake_torque_nm"][faulty:] == 0.0)
