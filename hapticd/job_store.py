"""Jobs on disk: a directory each, with the job's document and its files."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import structlog
from pydantic import ValidationError

from hapticd.job import Job, JobReport, JobSummary
from hapticd.problem import Problem

JOB_FILE = "job.json"

log = structlog.get_logger(__name__)


class JobStore:
    """The directory of the jobs."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory

    def make(self, summary: JobSummary) -> Job:
        """A new job with its directory. ``Problem`` (storage-failed)."""
        job = Job(summary, self.directory / summary.id)
        try:
            job.directory.mkdir(parents=True)
        except OSError as error:
            raise Problem("storage-failed", f"{job.directory} cannot be made: {error.strerror}.") from error
        self.save(job)
        return job

    def save(self, job: Job) -> None:
        """Writes the job's document. A disk that refuses it is logged: the job goes on."""
        document = {**job.summary().model_dump(mode="json"), "error": job.error}
        try:
            (job.directory / JOB_FILE).write_text(json.dumps(document, indent=1), encoding="utf-8")
        except OSError as error:
            log.error("job not written", job=job.id, error=str(error))

    def load(self) -> list[Job]:
        """Every job, the oldest first. One that was not at its end when the daemon stopped has failed."""
        jobs = sorted(self._read(), key=lambda job: job.summary().created_utc)
        for job in jobs:
            if not job.has_ended:
                job.fail(Problem("experiment-failed", "The daemon stopped before the job had ended."))
                self.save(job)
        return jobs

    def remove(self, job: Job) -> None:
        """Forgets a job and its files."""
        shutil.rmtree(job.directory, ignore_errors=True)

    def _read(self) -> Iterator[Job]:
        for file in self.directory.glob(f"*/{JOB_FILE}"):
            try:
                report = JobReport.model_validate_json(file.read_text(encoding="utf-8"))
            except (OSError, ValidationError) as error:
                # Cut short by a power failure; the others stand.
                log.warning("job unreadable", file=str(file), error=str(error))
                continue
            summary = JobSummary(**report.model_dump(include=set(JobSummary.model_fields)))
            yield Job(summary, file.parent, report.error)
