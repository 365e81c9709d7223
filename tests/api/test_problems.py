"""Every error is a problem document that names the field, the cause and the cure."""

from __future__ import annotations

import json
from typing import Any

import httpx
import pytest

from hapticd.problem_types import PROBLEM_TYPES
from tests.api.conftest import Rig
from tests.api.documents import floor

WALL = "/api/v1/devices/phantom/scene/walls/floor"


def problem_of(response: httpx.Response, status: int, slug: str) -> dict[str, Any]:
    """The problem document of a response, which must be one and of this kind."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    document: dict[str, Any] = response.json()
    assert document["type"] == f"/problems/{slug}"
    assert document["status"] == status
    assert document["title"]
    assert document["detail"]
    assert document["hint"]
    return document


async def test_unknown_path_is_a_problem_document(http: httpx.AsyncClient) -> None:
    problem_of(await http.get("/api/v1/nothing"), 404, "route-not-found")


async def test_wrong_verb_names_the_verbs_that_exist(http: httpx.AsyncClient) -> None:
    response = await http.delete("/api/v1/devices")
    problem = problem_of(response, 405, "method-not-allowed")
    assert "GET" in problem["allowed"]
    assert "GET" in response.headers["allow"]


async def test_unknown_device_lists_those_there_are(http: httpx.AsyncClient) -> None:
    problem = problem_of(await http.get("/api/v1/devices/fantom"), 404, "device-not-found")
    assert problem["allowed"] == ["phantom", "hhd", "bench"]


@pytest.mark.parametrize(
    ("change", "slug", "pointer"),
    [
        ({"colour": "red"}, "unknown-field", "/colour"),
        ({"law": {"type": "motion", "eta": 0.0, "etta": 1}}, "unknown-field", "/law/etta"),
        ({"law": {"type": "motion", "eta": 1.2}}, "invalid-document", "/law/eta"),
        ({"law": {"type": "motion"}}, "invalid-document", "/law/eta"),
        ({"law": {"type": "motion", "eta": "0.5"}}, "invalid-document", "/law/eta"),
        (
            {"shape": {"type": "plane", "point_m": [0, 0, 0], "normal": [0, 0, 0]}},
            "invalid-document",
            "/shape/normal",
        ),
        (
            {"shape": {"type": "plane", "point_m": [0, 0, 0], "normal": [0, 0, 2]}},
            "invalid-document",
            "/shape/normal",
        ),
        (
            {"shape": {"type": "plane", "point_m": [0, 0], "normal": [0, 1]}},
            "dimension-mismatch",
            "/shape/point_m",
        ),
        ({"id": "ceiling"}, "invalid-document", "/id"),
    ],
)
async def test_bad_wall_is_refused_by_the_field_and_changes_nothing(
    http: httpx.AsyncClient, rig: Rig, change: dict[str, Any], slug: str, pointer: str
) -> None:
    response = await http.put(WALL, json=floor(**change))
    assert problem_of(response, 422, slug)["pointer"] == pointer
    assert rig.station.devices["phantom"].scene.walls == ()
    assert rig.servos["phantom"].requests == []


async def test_misspelt_field_is_offered_its_correction(http: httpx.AsyncClient) -> None:
    response = await http.put(WALL, json={**floor(), "fade": 0.1})
    assert "'fade_s'" in problem_of(response, 422, "unknown-field")["hint"]
    response = await http.put("/api/v1/devices/phantom/state", json={"desierd": "enabled"})
    assert problem_of(response, 422, "invalid-document")["errors"]


async def test_pointer_into_a_scene_names_the_wall(http: httpx.AsyncClient) -> None:
    scene = {"walls": [floor(), floor(id="lid", law={"type": "motion", "eta": 7})]}
    response = await http.put("/api/v1/devices/phantom/scene", json=scene)
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/walls/1/law/eta"


async def test_pointer_into_a_tagged_union_leaves_out_the_tag(http: httpx.AsyncClient) -> None:
    hand = {"type": "push", "direction": [0, 0, -1], "force_n": -3}
    response = await http.put("/api/v1/devices/phantom/twin/hand", json=hand)
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/force_n"


@pytest.mark.parametrize("literal", ["NaN", "Infinity", "-Infinity", "1e999"])
async def test_number_that_is_not_finite_is_refused(http: httpx.AsyncClient, literal: str) -> None:
    body = json.dumps(floor()).replace("-0.02", literal)
    response = await http.put(WALL, content=body, headers={"Content-Type": "application/json"})
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/shape/point_m/2"


async def test_too_many_walls_are_refused(http: httpx.AsyncClient) -> None:
    scene = {"walls": [floor(id=f"w{index}") for index in range(257)]}
    response = await http.put("/api/v1/devices/phantom/scene", json=scene)
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/walls"


async def test_ten_thousand_walls_are_refused(http: httpx.AsyncClient) -> None:
    scene = {"walls": [floor(id=f"w{index}") for index in range(10_000)]}
    response = await http.put("/api/v1/devices/phantom/scene", json=scene)
    problem_of(response, 413, "body-too-large")


async def test_body_past_the_limit_is_refused_without_a_declared_length(http: httpx.AsyncClient) -> None:
    async def chunks() -> Any:
        for _ in range(40):
            yield b" " * 32_768

    response = await http.put(WALL, content=chunks(), headers={"Content-Type": "application/json"})
    problem_of(response, 413, "body-too-large")


@pytest.mark.parametrize("body", ["{", "", "[" * 100_000, '{"a": 1}}'])
async def test_body_that_is_not_json_says_so(http: httpx.AsyncClient, body: str) -> None:
    response = await http.put(WALL, content=body, headers={"Content-Type": "application/json"})
    slug = "invalid-document" if body == "" else "malformed-json"
    problem_of(response, 422 if body == "" else 400, slug)


async def test_body_of_another_media_type_is_refused(http: httpx.AsyncClient) -> None:
    response = await http.put(WALL, content="{}", headers={"Content-Type": "text/plain"})
    assert problem_of(response, 415, "unsupported-media-type")["allowed"] == ["application/json"]


async def test_bad_query_parameter_is_named(http: httpx.AsyncClient) -> None:
    response = await http.get("/api/v1/events?limit=-1")
    assert "limit" in problem_of(response, 422, "invalid-document")["detail"]


async def test_misspelt_dry_run_is_refused_instead_of_carried_out(http: httpx.AsyncClient, rig: Rig) -> None:
    response = await http.put(f"{WALL}?dryrun=true", json=floor())
    problem = problem_of(response, 422, "unknown-field")
    assert "'dry_run'" in problem["hint"]
    assert problem["allowed"] == ["dry_run", "force"]
    assert rig.servos["phantom"].requests == []


async def test_unforeseen_error_is_a_problem_document_and_tells_no_secrets(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> None:
        raise RuntimeError("the password is hunter2")

    monkeypatch.setattr(rig.station.devices["phantom"], "snapshot", fail)
    problem = problem_of(await http.get("/api/v1/devices/phantom"), 500, "internal-error")
    assert "hunter2" not in str(problem)


async def test_every_kind_of_problem_has_its_page(http: httpx.AsyncClient) -> None:
    for slug, kind in PROBLEM_TYPES.items():
        page = (await http.get(f"/problems/{slug}")).json()
        assert page["cause"] == kind.cause
        assert page["fix"] == kind.fix
    index = (await http.get("/problems")).json()
    assert len(index["problems"]) == len(PROBLEM_TYPES)


async def test_a_browser_gets_the_problem_as_a_page(http: httpx.AsyncClient) -> None:
    response = await http.get("/problems/unknown-field", headers={"Accept": "text/html,*/*"})
    assert response.headers["content-type"].startswith("text/html")
    assert "What cures it" in response.text
