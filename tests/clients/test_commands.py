"""The commands show what the daemon said, to people and to programs, and end with the right exit code."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from typer.testing import Result

from tests.clients.daemon_double import DaemonDouble, device, problem

Run = Callable[..., Result]
FLOOR_PATH = "/api/v1/devices/phantom/scene/walls/floor"
ADD_FLOOR = ("walls", "add", "phantom", "floor", "--point", "0,0,-0.02", "--normal", "0,0,1")


def floor(**members: Any) -> dict[str, Any]:
    return {"id": "floor", "shape": {}, "law": {"type": "motion", "eta": 0.0}, **members}


def wall_result(**members: Any) -> dict[str, Any]:
    return {
        "wall": floor(),
        "stiffness_n_per_m": 912.4,
        "granted": granted(912.4),
        "etag": '"8"',
        "revision": 8,
        "applied": {"tick": 4711, "t_mono_ns": 1, "fade_s": 0.2, "clamped": []},
        "dry_run": False,
        "note": None,
        **members,
    }


def granted(stiffness_n_per_m: float, **members: Any) -> dict[str, Any]:
    return {
        "stiffness_n_per_m": stiffness_n_per_m,
        "stiffness_fraction": 1.0,
        "forced": False,
        "why": [],
        **members,
    }


def state_report(device_id: str, state: str) -> dict[str, Any]:
    return {
        "device_id": device_id,
        "state": state,
        "flags": device()["flags"],
        "faults": [],
        "interlocks": [],
        "applied": {"tick": 12, "t_mono_ns": 1, "fade_s": 0.0, "clamped": []},
    }


def test_status_shows_each_device(run: Run, double: DaemonDouble) -> None:
    hhd = device("hhd", dof=2, tip_position_m=[0.1, 0.2], state="enabled")
    double.answer("GET /api/v1/devices", {"devices": [device(), hhd]})
    result = run("status")
    assert result.exit_code == 0
    phantom_line, hhd_line = result.stdout.splitlines()[1:3]
    assert "disabled" in phantom_line
    assert "0.50" in phantom_line
    assert "enabled" in hhd_line
    assert "100.0  200.0" in hhd_line


def test_status_says_what_is_wrong_and_what_cures_it(run: Run, double: DaemonDouble) -> None:
    fault = {"id": "encoder-jump", "severity": "stop_now", "cause": "It jumped.", "cure": "Check the cable."}
    offline = device("hhd", state="offline", health={"online": False, "why": "The servo died."})
    double.answer("GET /api/v1/devices", {"devices": [device(state="fault", faults=[fault]), offline]})
    result = run("status")
    assert "phantom: encoder-jump It jumped. Check the cable." in result.stdout
    assert "hhd: offline The servo died." in result.stdout


def test_status_as_json_is_what_the_daemon_said(run: Run, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices", {"devices": [device()]})
    assert json.loads(run("status", "--json").stdout) == [device()]


def test_a_device_name_is_not_read_as_markup(run: Run, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices", {"devices": [device("phantom", driver="[red]x[/red]")]})
    assert "[red]x[/red]" in run("status").stdout


def test_adding_a_wall_sends_it_and_tells_the_tick(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", wall_result(), status=201)
    result = run(*ADD_FLOOR, "--eta", "0.5")
    assert double.last_body["shape"] == {
        "type": "plane",
        "point_m": [0.0, 0.0, -0.02],
        "normal": [0.0, 0.0, 1.0],
    }
    assert double.last_body["law"] == {"type": "motion", "eta": 0.5}
    assert "in force since tick 4711, fading over 0.2 s; 912 N/m" in result.stdout


def test_adding_a_wall_never_replaces_one_unasked(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", wall_result())
    run(*ADD_FLOOR)
    assert double.requests[-1].headers["if-none-match"] == "*"
    run(*ADD_FLOOR, "--replace")
    assert "if-none-match" not in double.requests[-1].headers


def test_a_wall_that_no_loop_has_taken_is_not_called_in_force(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", wall_result(applied=None, note="The device is offline."))
    output = run(*ADD_FLOOR).stdout
    assert "not yet in force: The device is offline." in output
    assert "since tick" not in output


def test_a_dry_run_says_that_nothing_changed(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", wall_result(applied=None, dry_run=True))
    result = run(*ADD_FLOOR, "--dry-run")
    assert double.requests[-1].url.params["dry_run"] == "true"
    assert "Nothing was changed" in result.stdout


@pytest.mark.parametrize("spelt", ["up", "0,0,x", "0,0,nan", "0,0,inf", "1,2,3,4", "1", ""])
def test_a_vector_that_makes_no_sense_is_refused_before_anything_is_sent(
    run: Run, double: DaemonDouble, spelt: str
) -> None:
    result = run("walls", "add", "phantom", "floor", "--point", "0,0,0", "--normal", spelt)
    assert result.exit_code == 2
    assert not double.requests


def test_a_wall_of_a_planar_device_takes_two_numbers(run: Run, double: DaemonDouble) -> None:
    double.answer("PUT /api/v1/devices/hhd/scene/walls/left", wall_result())
    run("walls", "add", "hhd", "left", "--point", "-0.1,0", "--normal", "1,0")
    assert double.last_body["shape"] == {"type": "plane", "point_m": [-0.1, 0.0], "normal": [1.0, 0.0]}


def test_any_shape_law_and_friction_can_be_spelt(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", wall_result())
    run(
        *("walls", "add", "phantom", "floor", "--friction", "static=0.4 kinetic=0.3", "--force"),
        *("--shape", "sphere center_m=0.2,0,-0.03 radius_m=0.02 hollow=true"),
        *("--law", "spring stiffness_n_per_m=800 passivity=true"),
    )
    shape = {"type": "sphere", "center_m": [0.2, 0, -0.03], "radius_m": 0.02, "hollow": True}
    assert double.last_body["shape"] == shape
    assert double.last_body["law"] == {"type": "spring", "stiffness_n_per_m": 800, "passivity": True}
    assert double.last_body["friction"] == {"static": 0.4, "kinetic": 0.3}
    assert double.requests[-1].url.params["force"] == "true"


@pytest.mark.parametrize(
    "options",
    [
        (),
        ("--point", "0,0,0"),
        ("--point", "0,0,0", "--normal", "0,0,1", "--shape", "sphere radius_m=1"),
        ("--shape", "radius_m=1"),
        ("--shape", "sphere radius_m"),
    ],
)
def test_wall_that_is_not_one_shape_is_refused_before_anything_is_sent(
    run: Run, double: DaemonDouble, options: tuple[str, ...]
) -> None:
    result = run("walls", "add", "phantom", "floor", *options)
    assert result.exit_code == 2
    assert not double.requests


def test_a_grant_below_what_was_asked_for_is_told_with_its_reason(run: Run, double: DaemonDouble) -> None:
    spring = floor(law={"type": "spring", "stiffness_n_per_m": 3000})
    less = granted(1500.0, why=["The spring drive can give at most 1500 N/m."])
    double.answer(f"PUT {FLOOR_PATH}", wall_result(wall=spring, granted=less))
    assert "1500 N/m at this pose (The spring drive can give at most 1500 N/m.)" in run(*ADD_FLOOR).stdout


def test_a_wall_let_in_by_force_says_that_passivity_bounds_it(run: Run, double: DaemonDouble) -> None:
    forced = granted(0.0, forced=True, why=["It holds nothing.", "It was let in by force."])
    double.answer(f"PUT {FLOOR_PATH}", wall_result(granted=forced))
    assert "(It was let in by force.)" in run(*ADD_FLOOR, "--force").stdout


def test_walls_of_all_devices_are_listed(run: Run, double: DaemonDouble) -> None:
    wall = {
        "id": "floor",
        "shape": {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]},
        "law": {"type": "motion", "eta": 0.25},
        "enabled": False,
        "fade_s": 0.2,
    }
    double.answer("GET /api/v1/devices", {"devices": [device("phantom"), device("hhd")]})
    double.answer("GET /api/v1/devices/phantom/scene", {"walls": [wall]})
    double.answer("GET /api/v1/devices/hhd/scene", {"walls": []})
    line = run("walls", "list").stdout.splitlines()[1]
    assert " ".join(line.split()) == (
        "phantom floor plane point 0, 0, -0.02, normal 0, 0, 1 motion eta 0.25 – 0.2 off"
    )
    assert json.loads(run("walls", "list", "--json").stdout) == {"phantom": [wall], "hhd": []}


def test_an_empty_scene_says_how_to_fill_it(run: Run, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices/phantom/scene", {"walls": []})
    assert "hapticd walls add --help" in run("walls", "list", "phantom").stdout


def test_removing_a_wall_deletes_it(run: Run, double: DaemonDouble) -> None:
    double.answer(f"DELETE {FLOOR_PATH}", wall_result(wall=None, granted=None))
    assert "without floor is in force since tick 4711" in run("walls", "remove", "phantom", "floor").stdout


def test_a_refusal_shows_title_detail_interlocks_and_cure(run: Run, double: DaemonDouble) -> None:
    interlocks = [
        {"id": "estop-latched", "ok": False, "why": "It is latched.", "cure": "Acknowledge it."},
        {"id": "not-homed", "ok": True, "why": "Home it.", "cure": "Home it."},
    ]
    document = problem("interlock-open", 409, interlocks=interlocks)
    double.answer("PUT /api/v1/devices/phantom/state", document, status=409)
    result = run("enable", "phantom")
    assert result.exit_code == 1
    assert "Interlock open" in result.stderr
    assert "This is the detail of interlock-open." in result.stderr
    assert "estop-latched: It is latched. Acknowledge it." in result.stderr
    assert "not-homed" not in result.stderr
    assert "Cure: This cures interlock-open." in result.stderr
    assert not result.stdout


def test_a_cure_is_told_in_the_words_of_the_command_line(run: Run, double: DaemonDouble) -> None:
    double.answer(f"PUT {FLOOR_PATH}", problem("wall-exists", 409), status=409)
    assert "Cure: Replace the wall with --replace, or choose another id." in run(*ADD_FLOOR).stderr


def test_a_refusal_as_json_is_the_problem_document(run: Run, double: DaemonDouble) -> None:
    document = problem("device-not-found", 404)
    double.answer("GET /api/v1/devices/nobody/scene", document, status=404)
    result = run("walls", "list", "nobody", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stderr) == document
    assert not result.stdout


def test_a_daemon_that_is_not_there_ends_with_its_own_code(run: Run, double: DaemonDouble) -> None:
    double.fail("GET /api/v1/devices", httpx.ConnectError("Connection refused"))
    result = run("status")
    assert result.exit_code == 3
    assert "hapticd run" in result.stderr


def test_estop_without_a_name_stops_all(run: Run, double: DaemonDouble) -> None:
    reports = [{"device_id": "phantom", "engaged": True, "state": "disabled", "applied": None}]
    double.answer("PUT /api/v1/estop", {"engaged": True, "devices": reports})
    assert "E-STOP" in run("estop").stdout
    assert double.lines == ["PUT /api/v1/estop"]


def test_estop_reaches_the_second_device_although_the_first_refuses(run: Run, double: DaemonDouble) -> None:
    report = {"device_id": "hhd", "engaged": True, "state": "disabled", "applied": None}
    double.answer("PUT /api/v1/devices/phantom/estop", problem("servo-silent", 504), status=504)
    double.answer("PUT /api/v1/devices/hhd/estop", report)
    result = run("estop", "phantom", "hhd")
    assert double.lines[-1] == "PUT /api/v1/devices/hhd/estop"
    assert result.exit_code == 1


def test_disabling_reaches_the_second_device_although_the_first_refuses(
    run: Run, double: DaemonDouble
) -> None:
    double.answer("PUT /api/v1/devices/phantom/state", problem("servo-silent", 504), status=504)
    double.answer("PUT /api/v1/devices/hhd/state", state_report("hhd", "disabled"))
    result = run("disable", "phantom", "hhd")
    assert result.stdout.splitlines() == ["hhd is disabled since tick 12"]
    assert result.exit_code == 1


def test_estop_is_only_acknowledged_when_asked(run: Run, double: DaemonDouble) -> None:
    double.answer("DELETE /api/v1/estop", {"engaged": False, "devices": []})
    run("estop", "--acknowledge")
    assert double.lines == ["DELETE /api/v1/estop"]


def test_acknowledging_clears_every_latched_fault(run: Run, double: DaemonDouble) -> None:
    faults = [
        {"id": name, "severity": "stop_now", "cause": "", "cure": ""} for name in ("encoder", "amplifier")
    ]
    double.answer("GET /api/v1/devices/phantom", device(faults=faults))
    double.answer("DELETE /api/v1/devices/phantom/faults/encoder", {})
    double.answer("DELETE /api/v1/devices/phantom/faults/amplifier", {})
    result = run("acknowledge", "phantom")
    assert double.lines[1:] == [
        "DELETE /api/v1/devices/phantom/faults/encoder",
        "DELETE /api/v1/devices/phantom/faults/amplifier",
    ]
    assert "encoder, amplifier" in result.stdout


def test_enabling_several_devices_reports_each(run: Run, double: DaemonDouble) -> None:
    for name in ("phantom", "hhd"):
        double.answer(f"PUT /api/v1/devices/{name}/state", state_report(name, "enabled"))
    lines = run("enable", "phantom", "hhd").stdout.splitlines()
    assert lines == ["phantom is enabled since tick 12", "hhd is enabled since tick 12"]
