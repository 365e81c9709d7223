"""A POST that is sent twice with one key is carried out once."""

from __future__ import annotations

import asyncio

import httpx
import pytest

from hapticd_api import idempotency
from tests.api.conftest import Rig
from tests.api.documents import floor
from tests.api.test_problems import problem_of

WALLS = "/api/v1/devices/phantom/scene/walls"
KEY = {"Idempotency-Key": "a"}


async def test_repeated_post_gets_the_first_answer_and_acts_once(http: httpx.AsyncClient, rig: Rig) -> None:
    first = await http.post(WALLS, json=floor(), headers=KEY)
    second = await http.post(WALLS, json=floor(), headers=KEY)
    assert (first.status_code, second.status_code) == (201, 201)
    assert second.json() == first.json()
    assert second.headers["etag"] == first.headers["etag"]
    assert len(rig.servos["phantom"].requests) == 1


async def test_post_repeated_before_its_answer_acts_once(http: httpx.AsyncClient, rig: Rig) -> None:
    answers = await asyncio.gather(*(http.post(WALLS, json=floor(), headers=KEY) for _ in range(5)))
    assert {answer.status_code for answer in answers} == {201}
    assert len(rig.servos["phantom"].requests) == 1


async def test_refusal_is_repeated_as_well(http: httpx.AsyncClient) -> None:
    await http.post(WALLS, json=floor())
    problem_of(await http.post(WALLS, json=floor(), headers=KEY), 409, "wall-exists")
    await http.delete(f"{WALLS}/floor")
    problem_of(await http.post(WALLS, json=floor(), headers=KEY), 409, "wall-exists")


async def test_key_of_another_body_or_query_is_refused(http: httpx.AsyncClient) -> None:
    await http.post(WALLS, json=floor(), headers=KEY)
    problem_of(await http.post(WALLS, json=floor(id="lid"), headers=KEY), 422, "idempotency-key-reused")
    dry = await http.post(f"{WALLS}?dry_run=true", json=floor(), headers=KEY)
    problem_of(dry, 422, "idempotency-key-reused")


async def test_key_means_nothing_at_another_address(http: httpx.AsyncClient) -> None:
    await http.post(WALLS, json=floor(), headers=KEY)
    injection = {"type": "unplug", "duration_s": 0.25}
    response = await http.post("/api/v1/devices/phantom/twin/faults", json=injection, headers=KEY)
    assert response.status_code == 200


async def test_failure_is_not_repeated_but_tried_again(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr("hapticd.channel.ACK_TIMEOUT_S", 0.05)
        rig.servos["phantom"].mute = True
        problem_of(await http.post(WALLS, json=floor(), headers=KEY), 504, "servo-silent")
    rig.servos["phantom"].mute = False
    assert (await http.post(WALLS, json=floor(), headers=KEY)).status_code == 201


async def test_unforeseen_failure_is_tried_again(
    http: httpx.AsyncClient, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.delattr(type(rig.station.devices["phantom"]), "put_wall")
        problem_of(await http.post(WALLS, json=floor(), headers=KEY), 500, "internal-error")
    assert (await http.post(WALLS, json=floor(), headers=KEY)).status_code == 201


async def test_oldest_key_is_forgotten_when_there_are_too_many(
    http: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(idempotency, "KEYS_MAX", 1)
    await http.post(WALLS, json=floor(), headers=KEY)
    await http.post(WALLS, json=floor(id="lid"), headers={"Idempotency-Key": "b"})
    problem_of(await http.post(WALLS, json=floor(), headers=KEY), 409, "wall-exists")
