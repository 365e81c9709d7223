"""The API describes itself truthfully: OpenAPI, AsyncAPI, the docs page, metrics."""

from __future__ import annotations

import re
from importlib.resources import files
from typing import Any

import httpx
import orjson
import pytest
from prometheus_client.parser import text_string_to_metric_families

from hapticd.problem_types import PROBLEM_TYPES
from hapticd_api.stream.close import CloseCode
from hapticd_api.stream.message import CLIENT_MESSAGE
from tests.api.conftest import Rig

ASYNCAPI: dict[str, Any] = orjson.loads(files("hapticd_api").joinpath("asyncapi.json").read_bytes())
MESSAGES: dict[str, Any] = ASYNCAPI["components"]["messages"]

CONTRACT = {
    "/livez": "get",
    "/readyz": "get",
    "/metrics": "get",
    "/asyncapi.json": "get",
    "/api/v1/devices": "get",
    "/api/v1/devices/{device_id}": "get",
    "/api/v1/devices/{device_id}/state": "get put",
    "/api/v1/devices/{device_id}/interlocks": "get",
    "/api/v1/devices/{device_id}/faults": "get",
    "/api/v1/devices/{device_id}/faults/{fault_id}": "get delete",
    "/api/v1/devices/{device_id}/estop": "get put delete",
    "/api/v1/estop": "get put delete",
    "/api/v1/devices/{device_id}/scene": "get put patch",
    "/api/v1/devices/{device_id}/scene/walls": "get post",
    "/api/v1/devices/{device_id}/scene/walls/{wall_id}": "get put patch delete",
    "/api/v1/devices/{device_id}/twin/hand": "get put",
    "/api/v1/devices/{device_id}/twin/faults": "post",
    "/api/v1/system/realtime": "get",
    "/api/v1/events": "get",
    "/api/v1/experiments": "get post",
    "/api/v1/jobs/{job_id}": "get delete",
}


async def openapi(http: httpx.AsyncClient) -> dict[str, Any]:
    document: dict[str, Any] = (await http.get("/openapi.json")).json()
    return document


async def test_openapi_has_every_path_of_the_contract(http: httpx.AsyncClient) -> None:
    document = await openapi(http)
    assert document["openapi"].startswith("3.1")
    for path, verbs in CONTRACT.items():
        assert set(verbs.split()) <= set(document["paths"][path]), path


async def test_every_operation_is_named_and_explained(http: httpx.AsyncClient) -> None:
    names = []
    for path, verbs in (await openapi(http))["paths"].items():
        for verb, operation in verbs.items():
            names.append(operation["operationId"])
            assert re.fullmatch(r"[a-z]+(_[a-z]+)+", operation["operationId"]), path
            assert operation["summary"], path
            assert operation["description"], path
            assert operation["tags"], path
            if "{device_id}" in path:
                assert "404" in operation["responses"], (verb, path)
    assert len(names) == len(set(names))


async def test_every_documented_error_is_a_registered_problem(http: httpx.AsyncClient) -> None:
    for path, verbs in (await openapi(http))["paths"].items():
        for operation in verbs.values():
            for status, answer in operation["responses"].items():
                if int(status) < 400 or path == "/readyz":
                    continue
                content = answer["content"]["application/problem+json"]
                assert content["schema"] == {"$ref": "#/components/schemas/ProblemDocument"}
                for slug, example in content.get("examples", {}).items():
                    assert PROBLEM_TYPES[slug].status == int(status) == example["value"]["status"]


async def test_every_reference_in_openapi_leads_somewhere(http: httpx.AsyncClient) -> None:
    document = await openapi(http)
    for name in set(re.findall(r'"#/components/schemas/([^"]+)"', orjson.dumps(document).decode())):
        assert name in document["components"]["schemas"]


def test_asyncapi_lists_the_messages_a_client_may_send() -> None:
    schema = CLIENT_MESSAGE.json_schema()
    documented = {
        name: set(message["payload"]["properties"])
        for name, message in MESSAGES.items()
        if name in ("hello", "subscribe", "unsubscribe", "ping")
    }
    understood = {
        definition["properties"]["type"]["const"]: set(definition["properties"])
        for definition in schema["$defs"].values()
    }
    assert documented == understood


@pytest.mark.parametrize("name", ["hello", "subscribe", "unsubscribe", "ping"])
def test_example_of_a_client_message_is_understood(name: str) -> None:
    for example in MESSAGES[name]["examples"]:
        assert CLIENT_MESSAGE.validate_python(example["payload"]).type == name


def test_asyncapi_lists_every_close_code_of_the_daemon() -> None:
    documented = {code for channel in ASYNCAPI["channels"].values() for code in channel["x-close-codes"]}
    assert documented == {str(int(code)) for code in CloseCode}


def test_every_reference_in_asyncapi_leads_somewhere() -> None:
    for pointer in set(re.findall(r'"#/([^"]+)"', orjson.dumps(ASYNCAPI).decode())):
        here = ASYNCAPI
        for step in pointer.split("/"):
            here = here[step]


async def test_asyncapi_is_served(http: httpx.AsyncClient) -> None:
    document = (await http.get("/asyncapi.json")).json()
    assert document["channels"]["stream"]["address"] == "/api/v1/stream"


@pytest.mark.parametrize("page", ["/", "/docs", "/problems/unknown-field"])
async def test_page_loads_everything_from_the_daemon_itself(http: httpx.AsyncClient, page: str) -> None:
    html = (await http.get(page, headers={"Accept": "text/html"})).text
    loaded = re.findall(r'(?:src|href)="([^"]+)"', html)
    for address in loaded:
        assert address.startswith("/"), address
        assert not address.startswith("//"), address
        assert (await http.get(address)).status_code == 200, address
    assert "<script>" not in html


async def test_files_of_the_page_name_no_other_host(http: httpx.AsyncClient) -> None:
    for entry in files("hapticd_api").joinpath("page").iterdir():
        text = entry.read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"(https?:)?//[a-z0-9-]+\.[a-z]", text), entry.name


@pytest.mark.parametrize("name", ["../app.py", "%2e%2e/app.py", "..%2fapp.py", "app.py", "nothing.js"])
async def test_page_serves_no_file_but_its_own(http: httpx.AsyncClient, name: str) -> None:
    assert (await http.get(f"/page/{name}")).status_code == 404


async def test_readiness_names_what_fails(http: httpx.AsyncClient) -> None:
    response = await http.get("/readyz")
    assert response.status_code == 503
    assert response.json()["ready"] is False
    assert any("bench" in check for check in response.json()["failing"])


async def test_readiness_once_nothing_fails(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rig.station, "ready", list)
    response = await http.get("/readyz")
    assert response.status_code == 200
    assert response.json() == {"ready": True, "failing": []}


async def test_realtime_tells_the_scheduling_obtained(http: httpx.AsyncClient) -> None:
    devices = (await http.get("/api/v1/system/realtime")).json()["devices"]
    assert devices["phantom"]["scheduling"]["policy"] == "other"
    assert devices["phantom"]["missed_ticks"] == 2
    assert devices["bench"] is None


async def test_metrics_tell_states_ticks_and_requests(http: httpx.AsyncClient) -> None:
    await http.put("/api/v1/devices/phantom/estop")
    text = (await http.get("/metrics")).text
    samples = {
        (sample.name, *sorted(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }
    phantom = ("device", "phantom")
    assert samples["hapticd_device_estop", phantom] == 1
    assert samples["hapticd_device_estop", ("device", "hhd")] == 0
    assert samples["hapticd_device_state", phantom, ("state", "disabled")] == 1
    assert samples["hapticd_device_state", phantom, ("state", "enabled")] == 0
    assert samples["hapticd_ticks_missed_total", phantom] == 2
    lateness = ("phase", "lateness")
    assert samples["hapticd_tick_phase_seconds_bucket", phantom, ("le", "2e-06"), lateness] == 1
    assert samples["hapticd_tick_phase_seconds_bucket", phantom, ("le", "+Inf"), lateness] == 3
    assert samples["hapticd_tick_phase_seconds_sum", phantom, lateness] == pytest.approx(6e-6)
    route = ("route", "/api/v1/devices/{device_id}/estop")
    assert samples["hapticd_http_requests_total", ("method", "PUT"), route, ("status", "200")] == 1


async def test_metrics_do_not_grow_with_made_up_paths(http: httpx.AsyncClient) -> None:
    for number in range(5):
        await http.get(f"/made/up/{number}")
    assert "/made/up" not in (await http.get("/metrics")).text
