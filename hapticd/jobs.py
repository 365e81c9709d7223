"""The daemon's jobs: taken, queued, carried out one at a time, cancelled, remembered."""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import structlog

from hapticd.device import Device
from hapticd.events import EventLog
from hapticd.experiment_process import run_process
from hapticd.experiments.bench import DeviceExperiment
from hapticd.experiments.carry_out import Order
from hapticd.experiments.catalogue import CATALOGUE, experiment
from hapticd.experiments.experiment import Experiment
from hapticd.experiments.settings import own_names, resolve
from hapticd.experiments.station_run import check_enabled, run_on_device
from hapticd.job import ExperimentRequest, Job, JobSummary
from hapticd.job_store import JobStore
from hapticd.problem import Problem, json_pointer

KEPT = 50
"""Jobs remembered with their files; the oldest that have ended are forgotten first."""

QUEUE_MAX = 8

log = structlog.get_logger(__name__)


class Jobs:
    """Every job, the oldest first. Belongs to the event loop's thread."""

    def __init__(self, state_dir: Path, events: EventLog, device: Callable[[str], Device]) -> None:
        self._store = JobStore(state_dir / "jobs")
        self._experiments_dir = state_dir / "experiments"
        self._events = events
        self._device = device
        self._jobs = {job.id: job for job in self._store.load()}
        self._worker: asyncio.Task[None] | None = None
        self._stopping = False
        self._running: tuple[Job, asyncio.Task[list[str]]] | None = None
        self._forget_oldest()

    def all(self) -> list[Job]:
        """Every job that is remembered, the newest first."""
        return list(reversed(self._jobs.values()))

    def get(self, job_id: str) -> Job:
        """The job of this id. ``Problem``: job-not-found."""
        if job_id not in self._jobs:
            raise Problem("job-not-found", f"There is no job {job_id!r}.")
        return self._jobs[job_id]

    async def submit(self, request: ExperimentRequest) -> Job:
        """Queues an experiment.

        ``Problem``: experiment-not-found, parameter-unknown, parameter-invalid, experiment-simulated-only,
        device-not-found, device-not-enabled, too-many-jobs.
        """
        chosen = await asyncio.to_thread(_checked, request)
        if request.device_id is not None:
            self._check_device(chosen, request, self._device(request.device_id))
        if sum(not job.has_ended for job in self._jobs.values()) >= QUEUE_MAX:
            raise Problem("too-many-jobs", f"{QUEUE_MAX} jobs wait or run, which is the most.")
        job_id = f"{request.name}-{uuid.uuid4().hex[:8]}"
        job = self._store.make(JobSummary(id=job_id, request=request, created_utc=datetime.now(UTC)))
        self._jobs[job.id] = job
        self._forget_oldest()
        if self._worker is None or self._worker.done():
            self._worker = asyncio.create_task(self._work(), name="jobs")
        return job

    async def cancel(self, job_id: str) -> Job:
        """Cancels a job; it has let go of everything on return. ``Problem``: job-not-found, job-ended."""
        job = self.get(job_id)
        if job.has_ended:
            raise Problem("job-ended", f"The job {job.id} has {job.state}.", current_state=job.state)
        if self._running is not None and self._running[0] is job:
            work = self._running[1]
            work.cancel()
            await asyncio.wait({work})
            self._note_end(job, work)
        else:
            self._end(job, job.cancel)
        return job

    async def stop(self) -> None:
        """Ends the job that runs; those that wait have failed when the daemon comes back."""
        self._stopping = True
        if self._worker is not None:
            self._worker.cancel()
            with suppress(asyncio.CancelledError):
                await self._worker

    async def _work(self) -> None:
        while job := next((job for job in self._jobs.values() if job.state == "queued"), None):
            await self._carry_out(job)

    async def _carry_out(self, job: Job) -> None:
        job.start()
        self._tell(job, "job.started", f"The job {job.id} started.")
        work = asyncio.create_task(self._run(job), name=job.id)
        self._running = job, work
        try:
            await asyncio.wait({work})
        finally:
            # The worker itself was cancelled: the daemon stops.
            if not work.done():
                work.cancel()
                await asyncio.wait({work})
            self._running = None
            self._note_end(job, work)

    def _note_end(self, job: Job, work: asyncio.Task[list[str]]) -> None:
        """Notes how the work ended, once: both the worker and who cancelled it wait for it."""
        if job.has_ended:
            return
        error = None if work.cancelled() else work.exception()
        if work.cancelled() and self._stopping:
            self._end(
                job, lambda: job.fail(Problem("stopping", "The daemon stopped before the job had ended."))
            )
        elif work.cancelled():
            self._end(job, job.cancel)
        elif error is None:
            self._end(job, lambda: job.succeed(work.result()))
        elif isinstance(error, Problem):
            self._end(job, lambda: job.fail(error))
        else:
            log.error("job_failed", job=job.id, exc_info=error)
            self._end(job, lambda: job.fail(Problem("experiment-failed", f"{error!r}.")))

    async def _run(self, job: Job) -> list[str]:
        if job.request.device_id is None:
            return await run_process(self._child_request(job), job.directory, job.tell)
        chosen = experiment(job.request.name)
        assert isinstance(chosen, DeviceExperiment)
        order = Order(chosen, resolve(chosen, job.request.set), job.request.seed, out=job.directory)
        finished = await run_on_device(order, chosen, self._device(job.request.device_id), job.tell)
        return [file.name for file in finished.files]

    def _child_request(self, job: Job) -> dict[str, Any]:
        request = job.request
        return {
            "experiment": CATALOGUE[request.name],
            "set": request.set,
            "seed": request.seed,
            "jitter": request.jitter,
            "out": str(job.directory),
            "state_dir": str(self._experiments_dir / request.name),
        }

    def _check_device(self, chosen: Experiment, request: ExperimentRequest, device: Device) -> None:
        if not isinstance(chosen, DeviceExperiment) or request.jitter:
            what = (
                f"{chosen.name} runs on its own twin alone" if not request.jitter else "Jitter is for twins"
            )
            detail = f"{what}, not on {device.device_id}."
            raise Problem("experiment-simulated-only", detail, pointer="/device_id")
        if device.model_name not in chosen.device_models:
            known = " or ".join(chosen.device_models)
            detail = f"{chosen.name} needs a {known}; {device.device_id} is a {device.model_name}."
            raise Problem("experiment-simulated-only", detail, pointer="/device_id")
        if keys := [name for name in request.set if name not in own_names(chosen)]:
            detail = f"{keys[0]} is a key of a simulated device; {device.device_id} is as it is configured."
            pointer = json_pointer(("set", keys[0]))
            raise Problem("parameter-unknown", detail, pointer=pointer, allowed=own_names(chosen))
        check_enabled(device)

    def _end(self, job: Job, end: Callable[[], None]) -> None:
        end()
        self._store.save(job)
        self._tell(job, "job.ended", f"The job {job.id} {_ENDINGS[job.state]}.")

    def _tell(self, job: Job, kind: str, message: str) -> None:
        details = {"job": job.id, "state": job.state}
        self._events.append(kind, message, device_id=job.request.device_id, details=details)

    def _forget_oldest(self) -> None:
        ended = [job for job in self._jobs.values() if job.has_ended]
        for job in ended[: max(0, len(self._jobs) - KEPT)]:
            del self._jobs[job.id]
            self._store.remove(job)


_ENDINGS = {"succeeded": "has succeeded", "failed": "has failed", "cancelled": "was cancelled"}


def _checked(request: ExperimentRequest) -> Experiment:
    """The experiment that is asked for, its settings checked. Imports it, which takes its time."""
    try:
        chosen = experiment(request.name)
    except Problem as problem:
        problem.pointer = "/name"
        raise
    resolve(chosen, request.set)
    return chosen
