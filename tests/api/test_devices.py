"""Devices, their state, their E-stop, their faults."""

from __future__ import annotations

import httpx
import pytest

from hapticd.reasons import fault_bits
from tests.api.conftest import Rig
from tests.api.test_problems import problem_of


async def test_index_leads_to_resources_that_exist(http: httpx.AsyncClient) -> None:
    index = (await http.get("/api/v1")).json()
    for name, link in index["links"].items():
        if name != "stream":
            assert (await http.get(link)).status_code in (200, 503), link
    assert {"tip_position_m", "tip_force_n"} <= {signal["name"] for signal in index["signals"]}


async def test_devices_are_listed_in_the_order_of_the_configuration(http: httpx.AsyncClient) -> None:
    devices = (await http.get("/api/v1/devices")).json()["devices"]
    assert [device["id"] for device in devices] == ["phantom", "hhd", "bench"]
    assert [device["state"] for device in devices] == ["disabled", "disabled", "offline"]
    assert [device["twin"] for device in devices] == [True, True, False]


async def test_offline_device_says_why(http: httpx.AsyncClient) -> None:
    device = (await http.get("/api/v1/devices/bench")).json()
    assert device["health"]["online"] is False
    assert device["health"]["why"]
    assert device["tip_position_m"] is None


async def test_model_tells_the_geometry_in_force(http: httpx.AsyncClient) -> None:
    model = (await http.get("/api/v1/devices/phantom/model")).json()
    assert model["kinematics"]["l1_m"] == 0.14


async def test_number_that_is_not_finite_reaches_the_caller_as_null(
    http: httpx.AsyncClient, rig: Rig
) -> None:
    rig.servos["phantom"].force_is_nan = True
    device = (await http.get("/api/v1/devices/phantom")).json()
    assert device["tip_force_n"] == [None, None, None]


async def test_state_is_changed_and_tells_the_tick(http: httpx.AsyncClient) -> None:
    response = await http.put("/api/v1/devices/phantom/state", json={"desired": "enabled"})
    assert response.json()["state"] == "enabled"
    assert response.json()["applied"]["tick"] > 0
    assert (await http.get("/api/v1/devices/phantom/state")).json()["state"] == "enabled"


async def test_refused_state_names_the_open_interlock_and_its_cure(http: httpx.AsyncClient) -> None:
    await http.put("/api/v1/devices/phantom/estop")
    response = await http.put("/api/v1/devices/phantom/state", json={"desired": "enabled"})
    problem = problem_of(response, 409, "interlock-open")
    assert [interlock["id"] for interlock in problem["interlocks"]] == ["estop-latched"]
    assert problem["interlocks"][0]["cure"]
    assert problem["current_state"] == "disabled"
    interlocks = (await http.get("/api/v1/devices/phantom/interlocks")).json()["interlocks"]
    assert [interlock["id"] for interlock in interlocks if not interlock["ok"]] == ["estop-latched"]


async def test_state_of_an_offline_device_is_refused_as_such(http: httpx.AsyncClient) -> None:
    response = await http.put("/api/v1/devices/bench/state", json={"desired": "enabled"})
    assert problem_of(response, 409, "device-offline")["retryable"] is True


async def test_servo_that_does_not_answer_is_a_retryable_problem(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hapticd.channel.ACK_TIMEOUT_S", 0.05)
    rig.servos["phantom"].mute = True
    response = await http.put("/api/v1/devices/phantom/state", json={"desired": "enabled"})
    assert problem_of(response, 504, "servo-silent")["retryable"] is True


async def test_unknown_state_lists_those_that_can_be_asked_for(http: httpx.AsyncClient) -> None:
    response = await http.put("/api/v1/devices/phantom/state", json={"desired": "on"})
    problem = problem_of(response, 422, "invalid-document")
    assert problem["pointer"] == "/desired"
    assert "enabled" in problem["detail"]


async def test_estop_latches_until_it_is_acknowledged(http: httpx.AsyncClient) -> None:
    path = "/api/v1/devices/phantom/estop"
    assert (await http.put(path)).json()["engaged"] is True
    assert (await http.get(path)).json()["engaged"] is True
    assert (await http.delete(path)).json()["engaged"] is False
    assert (await http.get("/api/v1/devices/hhd/estop")).json()["engaged"] is False


async def test_estop_of_the_station_reaches_every_device_and_waits_for_one_without_a_servo(
    http: httpx.AsyncClient,
) -> None:
    report = (await http.put("/api/v1/estop")).json()
    assert {entry["device_id"]: entry["engaged"] for entry in report["devices"]} == {
        "phantom": True,
        "hhd": True,
        "bench": True,
    }
    assert [entry["device_id"] for entry in report["devices"] if entry["applied"] is None] == ["bench"]
    assert report["engaged"] is True
    assert (await http.delete("/api/v1/estop")).json()["engaged"] is False


async def test_estop_of_the_station_stops_the_others_when_one_is_silent(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hapticd.channel.ACK_TIMEOUT_S", 0.05)
    rig.servos["phantom"].mute = True
    problem_of(await http.put("/api/v1/estop"), 504, "servo-silent")
    assert rig.servos["hhd"].estop is True


async def test_fault_shows_its_cure_until_it_is_acknowledged(http: httpx.AsyncClient, rig: Rig) -> None:
    servo = rig.servos["phantom"]
    servo.faults, servo.state = fault_bits()["encoder-jump"], "fault"
    path = "/api/v1/devices/phantom/faults"
    faults = (await http.get(path)).json()["faults"]
    assert [fault["id"] for fault in faults] == ["encoder-jump"]
    assert (await http.get(f"{path}/encoder-jump")).json()["cure"]
    assert (await http.delete(f"{path}/encoder-jump")).json()["acknowledged"] == "encoder-jump"
    assert (await http.get(path)).json()["faults"] == []


async def test_fault_that_is_not_latched_cannot_be_acknowledged(http: httpx.AsyncClient) -> None:
    problem_of(await http.delete("/api/v1/devices/phantom/faults/encoder-jump"), 404, "fault-not-found")
    problem_of(await http.get("/api/v1/devices/phantom/faults/gremlins"), 404, "fault-not-found")


async def test_hand_of_a_twin_follows_a_bare_target(http: httpx.AsyncClient, rig: Rig) -> None:
    path = "/api/v1/devices/hhd/twin/hand"
    response = await http.put(path, json={"target_m": [0.0, 0.2]})
    assert response.json()["hand"] == {"type": "follow", "target_m": [0.0, 0.2]}
    assert rig.servos["hhd"].requests[-1]["script"] == {"type": "follow", "target_m": [0.0, 0.2, 0.0]}
    assert (await http.get(path)).json() == {"type": "follow", "target_m": [0.0, 0.2]}


async def test_hand_target_of_the_wrong_length_is_refused(http: httpx.AsyncClient) -> None:
    response = await http.put("/api/v1/devices/hhd/twin/hand", json={"target_m": [0.0, 0.2, 0.1]})
    assert problem_of(response, 422, "dimension-mismatch")["pointer"] == "/target_m"


async def test_hardware_has_no_simulated_hand(http: httpx.AsyncClient) -> None:
    problem_of(await http.get("/api/v1/devices/bench/twin/hand"), 409, "not-a-twin")
    response = await http.post("/api/v1/devices/bench/twin/faults", json={"type": "unplug"})
    problem_of(response, 409, "not-a-twin")


async def test_fault_is_injected_into_a_twin(http: httpx.AsyncClient, rig: Rig) -> None:
    injection = {"type": "unplug", "duration_s": 0.25}
    response = await http.post("/api/v1/devices/phantom/twin/faults", json=injection)
    assert response.json()["injection"] == injection
    assert rig.servos["phantom"].requests[-1] == {"type": "inject", "injection": injection}


async def test_events_resume_after_the_last_one_seen(http: httpx.AsyncClient, rig: Rig) -> None:
    for number in range(3):
        rig.station.events.append("test", f"Event {number}.")
    first = (await http.get("/api/v1/events?limit=2")).json()
    rest = (await http.get(f"/api/v1/events?after={first['last_id']}")).json()
    assert [event["message"] for event in first["events"]] == ["Event 0.", "Event 1."]
    assert [event["message"] for event in rest["events"]] == ["Event 2."]
    nothing = (await http.get(f"/api/v1/events?after={rest['last_id']}")).json()
    assert nothing["events"] == []
    assert nothing["last_id"] == rest["last_id"]
