"""Experiments as jobs: accepted, watched, cancelled, on twins of their own and on a device."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from hapticd.events import EventLog
from hapticd.experiments.commands import app
from hapticd.job import ExperimentRequest, JobSummary
from hapticd.job_store import JobStore
from hapticd.jobs import KEPT, Jobs
from tests.api.conftest import Rig
from tests.api.documents import floor
from tests.hapticd.experiments.fake_experiment import put_alone_into_catalogue

EXPERIMENTS = "/api/v1/experiments"
JOBS = "/api/v1/jobs"
WALLS = "/api/v1/devices/phantom/scene/walls"
ENDED = ("succeeded", "failed", "cancelled")


@pytest.fixture(autouse=True)
async def no_job_left(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[None]:
    """The small experiment alone, and no job running on after the test."""
    put_alone_into_catalogue(monkeypatch)
    yield
    await rig.station.jobs.stop()


async def submit(http: httpx.AsyncClient, **request: Any) -> httpx.Response:
    return await http.post(EXPERIMENTS, json={"name": "fake", **request})


async def job_of(http: httpx.AsyncClient, accepted: httpx.Response) -> dict[str, Any]:
    assert accepted.status_code == 202, accepted.text
    job: dict[str, Any] = (await http.get(accepted.headers["location"])).json()
    return job


async def watched(
    http: httpx.AsyncClient, accepted: httpx.Response, until: tuple[str, ...]
) -> dict[str, Any]:
    """The job once its state is one of these and, where it runs, it has told how far it is."""
    async with asyncio.timeout(60):
        while True:
            job = await job_of(http, accepted)
            if job["state"] in until and (job["state"] != "running" or job["progress"] > 0):
                return job
            assert job["state"] not in ENDED, job
            await asyncio.sleep(0.02)


async def ended(http: httpx.AsyncClient, accepted: httpx.Response) -> dict[str, Any]:
    return await watched(http, accepted, ENDED)


def problem(answer: httpx.Response, status: int, slug: str) -> dict[str, Any]:
    document: dict[str, Any] = answer.json()
    assert (answer.status_code, document["type"]) == (status, f"/problems/{slug}"), document
    return document


def kinds(rig: Rig) -> list[tuple[str, str]]:
    events = rig.station.events.after()
    return [(event.kind, event.details["state"]) for event in events if event.kind.startswith("job.")]


async def test_experiments_are_listed_and_described(http: httpx.AsyncClient) -> None:
    (entry,) = (await http.get(EXPERIMENTS)).json()["experiments"]
    assert entry["name"] == "fake"
    parameters = (await http.get(f"{EXPERIMENTS}/fake")).json()["parameters"]
    assert {"runs", "twin.hand.mass_kg"} <= {parameter["name"] for parameter in parameters}
    assert problem(await http.get(f"{EXPERIMENTS}/real"), 404, "experiment-not-found")["allowed"] == ["fake"]


async def test_a_job_ends_with_the_result_of_the_command_line_and_serves_its_files_alone(
    rig: Rig, http: httpx.AsyncClient
) -> None:
    accepted = await submit(http, set={"runs": 3}, seed=4, jitter=2)
    assert accepted.headers["location"] == f"{JOBS}/{accepted.json()['id']}"
    job = await ended(http, accepted)
    assert (job["state"], job["progress"], job["error"]) == ("succeeded", 1.0, None)
    assert job["result"]["parameters"]["runs"] == 3
    assert job["result"]["seed"] == 4
    assert job["result"]["jitter"][0]["draws"] == 2
    figure = await http.get(f"{JOBS}/{job['id']}/files/fake.png")
    assert (figure.headers["content-type"], figure.content[:4]) == ("image/png", b"\x89PNG")
    assert "fake-ticks.parquet" in job["files"]
    for name in ("job.json", "log.txt", "..%2Fjob.json"):
        assert (await http.get(f"{JOBS}/{job['id']}/files/{name}")).status_code == 404, name
    words = ["experiment", "run", "fake", "--set", "runs=3", "--seed", "4", "--jitter", "2", "--json"]
    assert json.loads(CliRunner().invoke(app, words).stdout) == job["result"]
    assert kinds(rig) == [("job.started", "running"), ("job.ended", "succeeded")]


async def test_one_job_runs_and_the_next_waits_its_turn(http: httpx.AsyncClient) -> None:
    first = await submit(http, set={"how": "long"})
    second = await submit(http, set={"runs": 1})
    running = await watched(http, first, ("running",))
    assert (running["progress"], running["doing"]) == (0.5, "waiting")
    assert (await job_of(http, second))["state"] == "queued"
    assert (await http.delete(first.headers["location"])).json()["state"] == "cancelled"
    assert (await ended(http, second))["state"] == "succeeded"
    listed = (await http.get(JOBS)).json()["jobs"]
    assert [job["state"] for job in listed] == ["succeeded", "cancelled"]
    assert "result" not in listed[0]


async def test_a_job_that_waits_can_be_cancelled(rig: Rig, http: httpx.AsyncClient) -> None:
    first = await submit(http, set={"how": "long"})
    second = await submit(http)
    assert (await http.delete(second.headers["location"])).json()["state"] == "cancelled"
    await http.delete(first.headers["location"])
    assert problem(await http.delete(second.headers["location"]), 409, "job-ended")
    await asyncio.sleep(0)
    assert kinds(rig) == [("job.started", "running"), *[("job.ended", "cancelled")] * 2]


async def test_no_more_than_a_few_jobs_wait(http: httpx.AsyncClient) -> None:
    accepted = [await submit(http, set={"how": "long"}) for _ in range(8)]
    assert problem(await submit(http), 503, "too-many-jobs")["retryable"]
    for job in reversed(accepted):
        await http.delete(job.headers["location"])


async def test_what_the_experiment_refuses_ends_the_job_with_that_problem(http: httpx.AsyncClient) -> None:
    job = await ended(http, await submit(http, set={"how": "badly"}))
    assert job["state"] == "failed"
    assert job["result"] is None
    assert (job["error"]["detail"], job["error"]["hint"]) == ("It goes badly.", "Let it go well.")


async def test_an_experiment_that_dies_says_what_its_log_said_last(http: httpx.AsyncClient) -> None:
    job = await ended(http, await submit(http, set={"how": "crash"}))
    assert job["error"]["type"] == "/problems/experiment-failed"
    assert "the ground is gone" in job["error"]["detail"]


@pytest.mark.parametrize(
    ("request_", "status", "slug", "pointer"),
    [
        ({"name": "real"}, 404, "experiment-not-found", "/name"),
        ({"set": {"speed": 1.0}}, 422, "parameter-unknown", "/set/speed"),
        ({"set": {"runs": 99}}, 422, "parameter-invalid", "/set/runs"),
        ({"seeds": 1}, 422, "unknown-field", "/seeds"),
        ({"device_id": "arm"}, 404, "device-not-found", None),
        ({"device_id": "hhd"}, 409, "device-not-enabled", None),
        ({"device_id": "hhd", "jitter": 3}, 409, "experiment-simulated-only", "/device_id"),
        (
            {"device_id": "hhd", "set": {"twin.hand.mass_kg": 1.0}},
            422,
            "parameter-unknown",
            "/set/twin.hand.mass_kg",
        ),
    ],
)
async def test_what_cannot_be_run_is_refused_at_once(
    http: httpx.AsyncClient, request_: dict[str, Any], status: int, slug: str, pointer: str | None
) -> None:
    document = problem(await submit(http, **request_), status, slug)
    assert document.get("pointer") == pointer
    assert (await http.get(JOBS)).json()["jobs"] == []


async def test_an_unknown_parameter_lists_the_known_ones(http: httpx.AsyncClient) -> None:
    document = problem(await submit(http, set={"speed": 1.0}), 422, "parameter-unknown")
    assert {"speed_m_per_s", "twin.hand.mass_kg"} <= set(document["allowed"])


async def test_a_job_nobody_made_is_not_found(http: httpx.AsyncClient) -> None:
    problem(await http.get(f"{JOBS}/fake-1"), 404, "job-not-found")
    problem(await http.delete(f"{JOBS}/fake-1"), 404, "job-not-found")


async def test_a_request_repeated_with_its_key_makes_one_job(http: httpx.AsyncClient) -> None:
    for _ in range(2):
        answer = await http.post(
            EXPERIMENTS, json={"name": "fake", "set": {"how": "long"}}, headers={"Idempotency-Key": "once"}
        )
        assert answer.status_code == 202
    (job,) = (await http.get(JOBS)).json()["jobs"]
    await http.delete(f"{JOBS}/{job['id']}")


async def enabled(rig: Rig, http: httpx.AsyncClient) -> None:
    """The PHANTOM with a floor, enabled."""
    assert (await http.post(WALLS, json=floor())).status_code == 201
    await http.put("/api/v1/devices/phantom/state", json={"desired": "enabled"})
    rig.servos["phantom"].requests.clear()


def rendered(rig: Rig) -> list[tuple[int, int]]:
    """Revision and number of walls of every scene that the loop was sent."""
    scenes = [request["scene"] for request in rig.servos["phantom"].requests if request["type"] == "scene"]
    return [(scene["revision"], len(scene["walls"])) for scene in scenes]


async def test_on_a_device_the_scene_from_before_is_put_back(rig: Rig, http: httpx.AsyncClient) -> None:
    await enabled(rig, http)
    revision = rig.servos["phantom"].revision
    job = await ended(http, await submit(http, device_id="phantom"))
    assert job["state"] == "succeeded", job["error"]
    assert job["result"]["device_id"] == "phantom"
    (lent, _), (restored, walls) = rendered(rig)
    assert lent > revision
    assert (restored, walls) == (revision, 1)
    hands = [request["script"] for request in rig.servos["phantom"].requests if request["type"] == "hand"]
    assert hands == [{"type": "hold", "stiff": True}, {"type": "hold", "stiff": False}]
    assert (await http.get("/api/v1/devices/phantom")).json()["scene_in_force"]


async def test_a_lent_device_is_busy_and_takes_no_edits_until_the_job_is_cancelled(
    rig: Rig, http: httpx.AsyncClient
) -> None:
    await enabled(rig, http)
    accepted = await submit(http, device_id="phantom", set={"how": "long"})
    await watched(http, accepted, ("running",))
    assert (await http.get("/api/v1/devices/phantom")).json()["flags"]["busy"]
    problem(await http.post(WALLS, json=floor(id="other")), 409, "device-lent")
    await rig.station.devices["phantom"].restore()
    assert len(rendered(rig)) == 1
    assert (await http.delete(accepted.headers["location"])).json()["state"] == "cancelled"
    assert rendered(rig)[-1] == (rig.station.devices["phantom"].snapshot().scene_revision, 1)
    assert (await http.post(WALLS, json=floor(id="other"))).status_code == 201


async def test_a_device_that_is_disabled_meanwhile_ends_the_job_and_gets_its_scene_back(
    rig: Rig, http: httpx.AsyncClient
) -> None:
    await enabled(rig, http)
    servo = rig.servos["phantom"]
    servo.on_scene = lambda: setattr(servo, "state", "disabled")
    job = await ended(http, await submit(http, device_id="phantom"))
    assert job["error"]["type"] == "/problems/device-not-enabled"
    assert len(rendered(rig)) == 2


async def test_the_command_line_runs_a_job_on_a_device_and_fetches_its_files(
    rig: Rig, http: httpx.AsyncClient, address: str, tmp_path: Path
) -> None:
    await enabled(rig, http)
    words = ["experiment", "run", "fake", "--device", "phantom", "--url", f"http://{address}"]
    run = CliRunner().invoke
    result = await asyncio.to_thread(run, app, [*words, "--out", str(tmp_path / "out"), "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["device_id"] == "phantom"
    assert (tmp_path / "out" / "fake.svg").exists()
    refused = await asyncio.to_thread(run, app, [*words, "--set", "runs=99"])
    assert "runs cannot be 99" in refused.stderr


async def test_jobs_outlive_the_daemon_and_one_cut_short_has_failed(
    rig: Rig, http: httpx.AsyncClient
) -> None:
    done = await ended(http, await submit(http, set={"runs": 1}))
    cut = await submit(http, set={"how": "long"})
    await watched(http, cut, ("running",))
    state_dir = rig.station.config.paths.state_dir
    again = Jobs(state_dir, EventLog(state_dir), rig.station.device)
    assert again.get(done["id"]).report().result == done["result"]
    assert again.get(cut.json()["id"]).report().error["detail"].startswith("The daemon stopped")


async def test_a_daemon_that_stops_ends_its_job(rig: Rig, http: httpx.AsyncClient) -> None:
    cut = await submit(http, set={"how": "long"})
    await watched(http, cut, ("running",))
    await rig.station.jobs.stop()
    job = await job_of(http, cut)
    assert (job["state"], job["error"]["type"]) == ("failed", "/problems/stopping")


def test_old_jobs_and_their_files_are_forgotten(tmp_path: Path, rig: Rig) -> None:
    store = JobStore(tmp_path / "jobs")
    for index in range(KEPT + 3):
        created = datetime.fromtimestamp(index, UTC)
        request = ExperimentRequest(name="fake")
        store.make(JobSummary(id=f"fake-{index}", request=request, state="failed", created_utc=created))
    jobs = Jobs(tmp_path, EventLog(tmp_path), rig.station.device)
    assert [job.id for job in jobs.all()] == [f"fake-{index}" for index in reversed(range(3, KEPT + 3))]
    assert len(list((tmp_path / "jobs").iterdir())) == KEPT
