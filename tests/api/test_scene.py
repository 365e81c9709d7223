"""Scenes and walls: conditional, dry, whole, and ready to be read, edited and sent back."""

from __future__ import annotations

import httpx
import pytest

from hapticd.flat_wall import rigid_plane, wall_key
from hapticd_api.wall_examples import PATCH_EXAMPLES, WALL_EXAMPLES
from tests.api.conftest import Rig
from tests.api.documents import floor
from tests.api.test_problems import problem_of

SCENE = "/api/v1/devices/phantom/scene"
WALLS = f"{SCENE}/walls"


async def test_scene_as_it_is_read_can_be_sent_back(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    read = await http.get(SCENE)
    response = await http.put(SCENE, json=read.json(), headers={"If-Match": read.headers["etag"]})
    assert response.status_code == 200
    assert response.json()["scene"] == read.json()


async def test_write_tells_the_tick_and_the_new_revision(http: httpx.AsyncClient, rig: Rig) -> None:
    response = await http.put(f"{WALLS}/floor", json=floor())
    result = response.json()
    assert response.status_code == 201
    assert result["applied"]["tick"] > 0
    assert result["applied"]["fade_s"] == 0.2
    assert result["stiffness_n_per_m"] == 1500.0
    assert response.headers["etag"] == result["etag"] == f'"{result["revision"]}"'
    sent = rig.servos["phantom"].requests[-1]["scene"]
    assert sent["revision"] == result["revision"]
    assert sent["walls"] == [rigid_plane([0.0, 0.0, 1.0], -0.02, key=wall_key("floor"))]


async def test_second_put_replaces_and_says_so(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    response = await http.put(f"{WALLS}/floor", json=floor(law={"type": "motion", "eta": 0.5}))
    assert response.status_code == 200
    assert response.json()["stiffness_n_per_m"] == 750.0
    assert [wall["id"] for wall in (await http.get(WALLS)).json()["walls"]] == ["floor"]


async def test_wall_takes_its_name_from_the_address(http: httpx.AsyncClient) -> None:
    document = floor()
    del document["id"]
    assert (await http.put(f"{WALLS}/left", json=document)).json()["wall"]["id"] == "left"


async def test_put_that_must_make_a_wall_does_not_replace_one(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    response = await http.put(f"{WALLS}/floor", json=floor(), headers={"If-None-Match": "*"})
    problem_of(response, 409, "wall-exists")


async def test_post_makes_a_wall_once_and_says_where(http: httpx.AsyncClient) -> None:
    response = await http.post(WALLS, json=floor())
    assert response.status_code == 201
    assert (await http.get(response.headers["location"])).json()["id"] == "floor"
    problem_of(await http.post(WALLS, json=floor()), 409, "wall-exists")


async def test_patch_of_a_wall_keeps_what_it_does_not_name(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    wall = (await http.patch(f"{WALLS}/floor", json={"law": {"eta": 0.25}})).json()["wall"]
    assert wall["law"] == {"type": "motion", "passivity": False, "brake": None, "eta": 0.25}
    assert wall["shape"]["point_m"] == [0, 0, -0.02]


async def test_patch_cannot_make_a_wall_invalid_or_rename_it(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    response = await http.patch(f"{WALLS}/floor", json={"law": {"eta": 2}})
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/law/eta"
    response = await http.patch(f"{WALLS}/floor", json={"id": "ceiling"})
    assert problem_of(response, 422, "invalid-document")["pointer"] == "/id"
    problem_of(await http.patch(f"{WALLS}/lid", json={}), 404, "wall-not-found")


async def test_patch_of_a_scene_keeps_its_walls(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    headers = {"Content-Type": "application/merge-patch+json"}
    response = await http.patch(SCENE, content='{"mapping": "inverse"}', headers=headers)
    scene = response.json()["scene"]
    assert scene["mapping"] == "inverse"
    assert [wall["id"] for wall in scene["walls"]] == ["floor"]


async def test_deleted_wall_is_gone(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    response = await http.delete(f"{WALLS}/floor")
    assert response.json()["wall"] is None
    assert response.json()["applied"]["tick"] > 0
    problem_of(await http.get(f"{WALLS}/floor"), 404, "wall-not-found")
    problem_of(await http.delete(f"{WALLS}/floor"), 404, "wall-not-found")


async def test_stale_edit_is_refused_and_changes_nothing(http: httpx.AsyncClient) -> None:
    stale = (await http.get(SCENE)).headers["etag"]
    await http.put(f"{WALLS}/floor", json=floor())
    headers = {"If-Match": stale}
    answers = [
        await http.put(SCENE, json={"walls": []}, headers=headers),
        await http.patch(SCENE, json={"walls": []}, headers=headers),
        await http.put(f"{WALLS}/floor", json=floor(enabled=False), headers=headers),
        await http.patch(f"{WALLS}/floor", json={"enabled": False}, headers=headers),
        await http.delete(f"{WALLS}/floor", headers=headers),
        await http.post(WALLS, json=floor(id="lid"), headers=headers),
    ]
    for answer in answers:
        problem_of(answer, 412, "revision-stale")
    assert (await http.get(f"{WALLS}/floor")).json()["enabled"] is True


async def test_reader_with_the_present_revision_is_told_so(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    for path in (SCENE, WALLS, f"{WALLS}/floor"):
        etag = (await http.get(path)).headers["etag"]
        again = await http.get(path, headers={"If-None-Match": f'"x", W/{etag}'})
        assert again.status_code == 304
        assert again.content == b""
        assert again.headers["etag"] == etag
    await http.delete(f"{WALLS}/floor")
    assert (await http.get(SCENE, headers={"If-None-Match": etag})).status_code == 200


async def test_dry_run_checks_everything_and_changes_nothing(http: httpx.AsyncClient, rig: Rig) -> None:
    etag = (await http.get(SCENE)).headers["etag"]
    answers = [
        await http.put(f"{WALLS}/floor?dry_run=true", json=floor()),
        await http.post(f"{WALLS}?dry_run=true", json=floor()),
        await http.put(f"{SCENE}?dry_run=true", json={"walls": [floor()]}),
    ]
    for answer in answers:
        assert answer.status_code == 200
        assert answer.json()["dry_run"] is True
        assert answer.json()["applied"] is None
    bad = await http.put(f"{WALLS}/floor?dry_run=true", json=floor(law={"type": "motion", "eta": 2}))
    problem_of(bad, 422, "invalid-document")
    assert (await http.get(SCENE)).headers["etag"] == etag
    assert rig.servos["phantom"].requests == []


async def test_edit_of_an_offline_device_is_kept_and_says_that_it_waits(http: httpx.AsyncClient) -> None:
    wall = floor(shape={"type": "plane", "point_m": [0, 0.1], "normal": [0, 1]})
    result = (await http.put("/api/v1/devices/bench/scene/walls/floor", json=wall)).json()
    assert result["applied"] is None
    assert "offline" in result["note"]
    assert (await http.get("/api/v1/devices/bench/scene/walls/floor")).status_code == 200


async def test_patch_to_another_law_leaves_nothing_of_the_old_one(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor(law={"type": "motion", "eta": 0.5, "passivity": True}))
    law = {"type": "spring", "stiffness_n_per_m": 800}
    wall = (await http.patch(f"{WALLS}/floor", json={"law": law})).json()["wall"]
    assert wall["law"] == {**law, "damping_n_s_per_m": 0, "passivity": False, "brake": None}
    wall = (await http.patch(f"{WALLS}/floor", json={"law": {"damping_n_s_per_m": 3}})).json()["wall"]
    assert (wall["law"]["stiffness_n_per_m"], wall["law"]["damping_n_s_per_m"]) == (800, 3)


async def test_patch_to_another_shape_needs_the_whole_of_it(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    ball = {"type": "sphere", "center_m": [0.2, 0, 0]}
    problem = problem_of(await http.patch(f"{WALLS}/floor", json={"shape": ball}), 422, "invalid-document")
    assert problem["pointer"] == "/shape/radius_m"
    answer = await http.patch(f"{WALLS}/floor", json={"shape": {**ball, "radius_m": 0.02}})
    assert answer.json()["wall"]["shape"] == {**ball, "radius_m": 0.02, "hollow": False}


async def test_patch_with_null_takes_friction_away(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor(friction={"static": 0.4, "kinetic": 0.3}))
    patch = {"friction": {"kinetic": 0.2}}
    wall = (await http.patch(f"{WALLS}/floor", json=patch)).json()["wall"]
    assert wall["friction"] == {"static": 0.4, "kinetic": 0.2, "actuator": "auto"}
    assert (await http.patch(f"{WALLS}/floor", json={"friction": None})).json()["wall"]["friction"] is None


async def test_wall_is_told_what_it_is_granted_on_write_and_on_read(http: httpx.AsyncClient) -> None:
    spring = {"type": "spring", "stiffness_n_per_m": 3000}
    written = (await http.put(f"{WALLS}/floor", json=floor(law=spring))).json()
    assert (written["granted"]["stiffness_n_per_m"], written["granted"]["stiffness_fraction"]) == (1500, 1)
    assert "at most 1500 N/m at this pose" in written["granted"]["why"][0]
    read = (await http.get(f"{WALLS}/floor")).json()
    assert read["granted"] == {**written["granted"], "budget": None}
    assert (await http.get(WALLS)).json()["walls"] == [read]
    again = await http.put(f"{WALLS}/floor", json=read)
    assert (again.status_code, again.json()["wall"]) == (200, written["wall"])


async def test_brake_on_a_device_without_is_refused_with_the_cure(http: httpx.AsyncClient) -> None:
    law = {"type": "motion", "eta": 0, "brake": True}
    answers = [
        await http.put(f"{WALLS}/floor", json=floor(law=law)),
        await http.put(SCENE, json={"walls": [floor(law=law)]}),
    ]
    for answer, inside in zip(answers, ["", "/walls/0"], strict=True):
        problem = problem_of(answer, 422, "no-brakes")
        assert problem["pointer"] == f"{inside}/law/brake"
        assert "Write null" in problem["hint"]


@pytest.mark.parametrize("name", sorted(WALL_EXAMPLES))
async def test_every_example_of_a_wall_is_accepted(http: httpx.AsyncClient, name: str) -> None:
    wall = WALL_EXAMPLES[name]["value"]
    device = "phantom" if name not in ("cubic_damper", "rectangle") else "hhd"
    answer = await http.post(f"/api/v1/devices/{device}/scene/walls", json=wall)
    assert answer.status_code == 201, answer.text


@pytest.mark.parametrize("name", sorted(PATCH_EXAMPLES))
async def test_every_example_of_a_patch_is_accepted(http: httpx.AsyncClient, name: str) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    answer = await http.patch(f"{WALLS}/floor", json=PATCH_EXAMPLES[name]["value"])
    assert answer.status_code == 200, answer.text


STEEP = {"type": "damper", "damping_n_s_per_m": 10_000}


async def test_wall_over_the_stability_budget_is_refused_and_force_bounds_it(http: httpx.AsyncClient) -> None:
    refused = problem_of(
        await http.put(f"{WALLS}/floor", json=floor(law=STEEP)), 422, "over-stability-budget"
    )
    assert refused["pointer"] == "/law/damping_n_s_per_m"
    assert "force=true" in refused["hint"]
    problem_of(await http.get(f"{WALLS}/floor"), 404, "wall-not-found")
    result = (await http.put(f"{WALLS}/floor?force=true", json=floor(law=STEEP))).json()
    assert result["wall"]["law"]["passivity"] is True
    assert result["granted"]["forced"] is True
    assert result["granted"]["budget"]["verdict"] == "unstable"


async def test_every_way_to_write_a_wall_asks_the_stability_budget(http: httpx.AsyncClient) -> None:
    await http.put(f"{WALLS}/floor", json=floor())
    off = floor(id="off", law=STEEP, enabled=False)
    assert (await http.put(f"{WALLS}/off", json=off)).status_code == 201
    answers = {
        "/law/damping_n_s_per_m": await http.post(WALLS, json=floor(id="steep", law=STEEP)),
        "/walls/0/law/damping_n_s_per_m": await http.put(SCENE, json={"walls": [floor(law=STEEP)]}),
    }
    for pointer, answer in answers.items():
        assert problem_of(answer, 422, "over-stability-budget")["pointer"] == pointer
    for name, patch in {"floor": {"law": STEEP}, "off": {"enabled": True}}.items():
        answer = await http.patch(f"{WALLS}/{name}", json=patch)
        assert problem_of(answer, 422, "over-stability-budget")["pointer"] == "/law/damping_n_s_per_m"


async def test_dry_run_tells_the_stability_budget(http: httpx.AsyncClient) -> None:
    result = (await http.put(f"{WALLS}/floor?dry_run=true", json=floor())).json()
    assert result["applied"] is None
    assert result["granted"]["budget"]["verdict"] in ("passive", "stable")
