"""Edits of a scene: whole or not at all, the loop, the disk and the log agreeing."""

import asyncio
from typing import Any

import pytest

from hapticd import channel
from hapticd.edit_terms import Terms
from hapticd.problem import Problem
from hapticd.scene import Scene
from tests.hapticd.conftest import Bench, make_wall, settle


@pytest.fixture
async def attached(bench: Bench) -> Bench:
    await bench.attach()
    return bench


async def test_edit_is_in_force_on_disk_and_told_when_it_is_answered(attached: Bench) -> None:
    result = await attached.device.put_wall(make_wall("floor", eta=0.5, fade_s=0.3))
    (request,) = attached.link.requests
    assert request["scene"]["revision"] == result.revision
    assert (result.applied.fade_s if result.applied else None) == 0.3
    assert attached.stored()["revision"] == result.revision
    assert attached.stored()["scene"]["walls"][0]["id"] == "floor"
    event = attached.events.after()[-1]
    assert (event.kind, event.tick) == ("scene.changed", result.applied.tick if result.applied else None)
    assert result.etag == attached.device.scene_etag == f'"{result.revision}"'
    assert attached.device.scene_in_force


async def test_edit_tells_the_stiffness_each_wall_comes_to(attached: Bench) -> None:
    result = await attached.device.put_wall(make_wall("soft", eta=0.25))
    assert [(wall.id, wall.stiffness_n_per_m) for wall in result.walls] == [("soft", 1500.0)]


async def test_offline_edit_is_kept_on_disk_and_goes_into_force_later(bench: Bench) -> None:
    result = await bench.device.put_wall(make_wall("floor"))
    assert result.applied is None
    assert result.note is not None
    assert "offline" in result.note
    assert bench.stored()["revision"] == result.revision
    bench.link.run()
    bench.device.attach(bench.link)
    await bench.device.restore()
    assert bench.link.requests[-1]["scene"]["revision"] == result.revision
    assert bench.device.scene_in_force


async def test_scene_survives_a_restart_of_the_daemon(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"))
    again = Bench(attached.state_dir).device
    assert again.scene == attached.device.scene
    assert again.scene_etag == attached.device.scene_etag
    assert again.snapshot().state == "offline"


async def test_stale_etag_changes_nothing(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"))
    etag = attached.device.scene_etag
    await attached.device.put_wall(make_wall("roof"), Terms(if_match=etag))
    sent = len(attached.link.requests)
    with pytest.raises(Problem) as caught:
        await attached.device.delete_wall("floor", Terms(if_match=etag))
    assert (caught.value.slug, caught.value.status) == ("revision-stale", 412)
    assert attached.device.scene_etag in caught.value.detail
    assert len(attached.link.requests) == sent
    assert [wall.id for wall in attached.device.scene.walls] == ["floor", "roof"]


@pytest.mark.parametrize("form", ["{}", "*", '"99", {}'])
async def test_etag_that_fits_is_accepted_in_every_form(attached: Bench, form: str) -> None:
    if_match = form.format(attached.device.scene_etag)
    assert (await attached.device.put_wall(make_wall("floor"), Terms(if_match=if_match))).applied


async def test_dry_run_checks_and_changes_nothing(attached: Bench) -> None:
    etag = attached.device.scene_etag
    result = await attached.device.put_wall(make_wall("floor", eta=0.5), Terms(dry_run=True))
    assert (result.applied, result.dry_run, result.etag) == (None, True, etag)
    assert [wall.stiffness_n_per_m for wall in result.walls] == [1000.0]
    assert attached.link.requests == []
    assert attached.device.scene == Scene()
    flat = {"type": "plane", "point_m": [0, 0], "normal": [0, 1]}
    with pytest.raises(Problem, match="2 components"):
        await attached.device.put_wall(make_wall("floor", shape=flat), Terms(dry_run=True))


async def test_edits_at_the_same_time_are_all_kept(attached: Bench) -> None:
    results = await asyncio.gather(*(attached.device.put_wall(make_wall(f"w{n}")) for n in range(20)))
    assert {wall.id for wall in attached.device.scene.walls} == {f"w{n}" for n in range(20)}
    assert len({result.revision for result in results}) == 20
    assert [request["scene"]["revision"] for request in attached.link.requests] == sorted(
        result.revision for result in results
    )


async def test_edit_is_finished_when_its_caller_goes_away(attached: Bench) -> None:
    edit = asyncio.create_task(attached.device.put_wall(make_wall("floor")))
    await settle()
    edit.cancel()
    with pytest.raises(asyncio.CancelledError):
        await edit
    # The next edit waits its turn behind the abandoned one.
    await attached.device.put_wall(make_wall("roof"))
    assert [wall["id"] for wall in attached.stored()["scene"]["walls"]] == ["floor", "roof"]


async def test_edit_nobody_acknowledged_is_not_taken_as_done_and_its_number_not_reused(
    attached: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(channel, "ACK_TIMEOUT_S", 0.02)
    attached.link.mute = True
    with pytest.raises(Problem, match="did not acknowledge"):
        await attached.device.put_wall(make_wall("floor"))
    assert attached.device.scene == Scene()
    attached.link.mute = False
    await attached.device.put_wall(make_wall("roof"))
    lost, kept = (request["scene"]["revision"] for request in attached.link.requests)
    assert kept > lost


async def test_making_a_wall_that_exists_is_refused(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"), create_only=True)
    with pytest.raises(Problem) as caught:
        await attached.device.put_wall(make_wall("floor", eta=1.0), create_only=True)
    assert caught.value.slug == "wall-exists"
    assert attached.device.get_wall("floor").law.eta == 0.0


async def test_wall_that_is_not_there_is_not_found(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"))
    with pytest.raises(Problem) as caught:
        await attached.device.delete_wall("flor")
    assert (caught.value.slug, caught.value.allowed) == ("wall-not-found", ["floor"])
    with pytest.raises(Problem):
        attached.device.get_wall("flor")


async def test_disk_that_refuses_is_told_and_the_scene_stays_in_force(
    attached: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(attached.store, "save", refuse)
    with pytest.raises(Problem, match="No space left") as caught:
        await attached.device.put_wall(make_wall("floor"))
    assert caught.value.slug == "storage-failed"
    assert attached.device.scene_in_force
    assert [wall.id for wall in attached.device.scene.walls] == ["floor"]
    assert attached.kinds()[-1] == "scene.not_saved"


async def test_corrupt_scene_file_is_told_and_the_device_starts_empty(bench: Bench) -> None:
    await bench.device.put_wall(make_wall("floor"))
    (bench.state_dir / "phantom.json").write_text("{")
    again = Bench(bench.state_dir)
    assert again.device.scene == Scene()
    assert again.kinds()[-1] == "scene.corrupt"
    assert again.device.scene_etag != bench.device.scene_etag
