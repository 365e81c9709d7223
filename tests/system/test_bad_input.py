"""Bad input: a clear problem that names the field, and nothing changed."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.system.daemon_process import FLOOR, HHD, PHANTOM, DaemonProcess

pytestmark = pytest.mark.system


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaemonProcess]:
    """One daemon for all, with the floor in place: no case may change it."""
    directory: Path = tmp_path_factory.mktemp("daemon")
    daemon = DaemonProcess(directory, [PHANTOM, HHD]).start()
    daemon.put("phantom/scene/walls/floor", FLOOR)
    yield daemon
    daemon.stop()


def wall(**changes: Any) -> dict[str, Any]:
    """The floor with some members changed."""
    return {**FLOOR, **changes}


def plane(point_m: list[float], normal: list[float]) -> dict[str, Any]:
    return {"type": "plane", "point_m": point_m, "normal": normal}


def motion(eta: object) -> dict[str, Any]:
    return {"type": "motion", "eta": eta}


CASES = {
    "unknown field": ("phantom", wall(stifness=3), 422, "/stifness"),
    "zero normal": ("phantom", wall(shape=plane([0, 0, 0], [0, 0, 0])), 422, "/shape/normal"),
    "normal not of unit length": ("phantom", wall(shape=plane([0, 0, 0], [0, 0, 2])), 422, "/shape/normal"),
    "eta past one": ("phantom", wall(law=motion(1.2)), 422, "/law/eta"),
    "eta as text": ("phantom", wall(law=motion("soft")), 422, "/law/eta"),
    "unknown law": ("phantom", wall(law={"type": "jelly"}), 422, "/law"),
    "millimetres": ("phantom", wall(shape=plane([0, 0, -20.0], [0, 0, 1])), 422, "/shape/point_m/2"),
    "two coordinates on a device of three": (
        "phantom",
        wall(shape=plane([0, 0], [0, 1])),
        422,
        "/shape/point_m",
    ),
    "three coordinates on a device of two": ("hhd", wall(), 422, "/shape/point_m"),
    "another id than the address": ("phantom", wall(id="ceiling"), 422, "/id"),
}


@pytest.mark.parametrize("case", CASES)
def test_wall_is_refused_by_name_and_nothing_changes(daemon: DaemonProcess, case: str) -> None:
    device_id, document, status, pointer = CASES[case]
    before = daemon.http.get("/api/v1/devices/phantom/scene")
    answer = daemon.http.put(f"/api/v1/devices/{device_id}/scene/walls/floor", json=document)
    problem = answer.json()
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert problem["pointer"].startswith(pointer), problem
    assert problem["detail"]
    assert daemon.http.get(problem["type"]).status_code == 200, "the problem type resolves on the daemon"
    after = daemon.http.get("/api/v1/devices/phantom/scene")
    assert (after.json(), after.headers["etag"]) == (before.json(), before.headers["etag"])


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity"])
def test_numbers_that_are_not_finite_are_refused(daemon: DaemonProcess, number: str) -> None:
    body = json.dumps(FLOOR).replace("-0.02", number)
    answer = daemon.http.put(
        "/api/v1/devices/phantom/scene/walls/floor",
        content=body,
        headers={"content-type": "application/json"},
    )
    assert answer.status_code in {400, 422}, answer.text
    assert answer.headers["content-type"] == "application/problem+json"


def test_ten_thousand_walls_are_refused_and_the_scene_stays(daemon: DaemonProcess) -> None:
    before = daemon.http.get("/api/v1/devices/phantom/scene").json()
    walls = [wall(id=f"wall-{i}") for i in range(10_000)]
    answer = daemon.http.put("/api/v1/devices/phantom/scene", json={"walls": walls})
    assert answer.status_code in {413, 422}, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert daemon.http.get("/api/v1/devices/phantom/scene").json() == before


def test_stale_etag_is_refused_and_the_other_writers_wall_stays(daemon: DaemonProcess) -> None:
    address = "/api/v1/devices/phantom/scene/walls/floor"
    stale = daemon.http.get("/api/v1/devices/phantom/scene").headers["etag"]
    daemon.put("phantom/scene/walls/floor", wall(law=motion(0.25)))
    answer = daemon.http.put(address, json=wall(law=motion(0.75)), headers={"if-match": stale})
    assert answer.status_code == 412, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert daemon.http.get(address).json()["law"]["eta"] == 0.25
