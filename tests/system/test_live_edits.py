"""Edits over HTTP while the hand pushes: each is acknowledged at a tick, none steps the force."""

from __future__ import annotations

import time
from functools import partial
from typing import Any

import numpy as np
import pytest

from tests.system.conftest import StartDaemon
from tests.system.daemon_process import FLOOR, UNDER_FLOOR, DaemonProcess, wait_until
from tests.system.tick_log import TickLog

pytestmark = pytest.mark.system

LEDGE = {
    "id": "floor",
    "shape": {"type": "plane", "point_m": [0, 0.18], "normal": [0, 1]},
    "law": {"type": "motion", "eta": 0.0},
}
"""A rigid wall below the HHD's home."""

DEVICES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "phantom": (FLOOR, UNDER_FLOOR),
    "hhd": (LEDGE, {"type": "push", "direction": [0, -1], "force_n": 15.0, "speed_m_per_s": 0.1}),
}
SETTLE_S = 0.3
STEP_MAX_N = {"phantom": 4.0, "hhd": 65.0}
"""The slew limit a tick at 1 kHz; on the HHD what its brakes add comes on top."""


def edits(wall: dict[str, Any]) -> list[tuple[str, str, Any]]:
    """Method, path below the scene, and document of every kind of edit, each with the wall touched."""
    floor = "/walls/floor"
    away = [0.001 * component for component in wall["shape"]["normal"]]
    raised = [a + b for a, b in zip(wall["shape"]["point_m"], away, strict=True)]
    spring = {"type": "spring", "stiffness_n_per_m": 700, "damping_n_s_per_m": 1, "passivity": True}
    return [
        ("PATCH", floor, {"shape": {"point_m": raised}}),
        ("PATCH", floor, {"law": {"eta": 0.5}}),
        ("PATCH", floor, {"law": spring}),
        ("PATCH", floor, {"law": {"stiffness_n_per_m": 1400}}),
        ("PATCH", floor, {"friction": {"static": 0.4, "kinetic": 0.3}}),
        ("POST", "/walls", {**wall, "id": "second", "law": {"type": "motion", "eta": 0.3}}),
        ("PATCH", "", {"mapping": "inverse"}),
        ("DELETE", "/walls/second", None),
        ("PATCH", floor, {"law": {"type": "cubic_damper"}}),
        ("PATCH", floor, {"enabled": False}),
        ("PATCH", floor, {"enabled": True, "law": wall["law"]}),
        ("PUT", "", {"walls": [{**wall, "id": "another"}]}),
    ]


def carry_out(daemon: DaemonProcess, device: str, edit: tuple[str, str, Any]) -> None:
    """Sends an edit, which must reach the loop."""
    method, path, document = edit
    answer = daemon.http.request(method, f"/api/v1/devices/{device}/scene{path}", json=document)
    assert answer.is_success, answer.text
    assert answer.json()["applied"]["tick"] > 0


def is_held(daemon: DaemonProcess, device: str) -> bool:
    """Whether the device touches the wall of the last edit."""
    return bool(daemon.device(device)["contact_wall"] == "another")


def check(log: TickLog, device: str, count: int) -> None:
    """That all edits were in force one after the other, and that none stepped the force."""
    ticks = log.ticks
    whole = np.diff(ticks["tick"]) == 1
    step_n = np.linalg.norm(np.diff(ticks["tip_force_n"], axis=0), axis=1)[whole]
    assert step_n.max() <= STEP_MAX_N[device] * 1.001
    assert len(set(ticks["scene_revision"])) >= count


def test_no_edit_over_http_steps_the_force_and_the_last_wall_holds(start_daemon: StartDaemon) -> None:
    daemon = start_daemon()
    for device, (wall, push) in DEVICES.items():
        daemon.press(device, wall, push)
    every = {device: edits(wall) for device, (wall, _) in DEVICES.items()}
    with TickLog(daemon.region("phantom")) as phantom, TickLog(daemon.region("hhd")) as hhd:
        for pair in zip(*every.values(), strict=True):
            for device, edit in zip(every, pair, strict=True):
                carry_out(daemon, device, edit)
            time.sleep(SETTLE_S)
        for device in every:
            wait_until(partial(is_held, daemon, device), f"{device} to touch the last wall")
    for log, device in ((phantom, "phantom"), (hhd, "hhd")):
        check(log, device, len(every[device]))
        assert daemon.device(device)["state"] == "enabled"
