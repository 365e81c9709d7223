"""A job: slow work that the daemon does beside its devices, and what is known of it."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from hapticd.document import Document
from hapticd.problem import Problem
from hapticd.snapshot import Report

JobState = Literal["queued", "running", "succeeded", "failed", "cancelled"]
Setting = float | int | bool | str | list[float]

JITTER_MAX = 1000


class ExperimentRequest(Document):
    """An experiment that shall be run."""

    name: str = Field(description="Name of an experiment", examples=["force-direction"])
    set: dict[str, Setting] = Field(
        default_factory=dict,
        description="Parameters of the experiment, and dotted keys of its device models",
        examples=[{"twin.hand.mass_kg": 1.2}],
    )
    seed: int = Field(1, ge=0, description="Equal seeds give equal results")
    jitter: int = Field(
        0, ge=0, le=JITTER_MAX, description="Runs more with everything uncertain drawn within ±10 %"
    )
    device_id: Annotated[str, Field(min_length=1)] | None = Field(
        None, description="Device to run on; without one, twins of the experiment's own"
    )


class JobSummary(Report):
    """A job, without its result."""

    id: str
    kind: Literal["experiment"] = "experiment"
    request: ExperimentRequest
    state: JobState = "queued"
    progress: float = Field(0.0, ge=0.0, le=1.0)
    doing: str = ""
    created_utc: datetime
    started_utc: datetime | None = None
    ended_utc: datetime | None = None
    files: tuple[str, ...] = ()


class JobReport(JobSummary):
    """A job with its result once it has succeeded, or the problem that ended it."""

    result: dict[str, Any] | None = None
    error: dict[str, Any] | None = None


class Job:
    """One job and its directory. Belongs to the event loop's thread."""

    def __init__(self, summary: JobSummary, directory: Path, error: dict[str, Any] | None = None) -> None:
        self._summary = summary
        self.directory = directory
        self.error = error

    @property
    def id(self) -> str:
        return self._summary.id

    @property
    def request(self) -> ExperimentRequest:
        return self._summary.request

    @property
    def state(self) -> JobState:
        return self._summary.state

    @property
    def has_ended(self) -> bool:
        return self.state not in ("queued", "running")

    def summary(self) -> JobSummary:
        """The job without its result."""
        return self._summary

    def report(self) -> JobReport:
        """The job with its result, read from its directory."""
        result = None
        if self.state == "succeeded":
            result = json.loads((self.directory / f"{self.request.name}.json").read_text(encoding="utf-8"))
        return JobReport(**self._summary.model_dump(), result=result, error=self.error)

    def file(self, name: str) -> Path:
        """One of its files. ``Problem`` (job-file-not-found) lists those there are."""
        # Only names that the job itself gave: no path that a caller makes up is ever opened.
        if name not in self._summary.files:
            detail = f"The job {self.id} has no file {name!r}."
            raise Problem("job-file-not-found", detail, allowed=self._summary.files)
        return self.directory / name

    def start(self) -> None:
        """It runs from now on."""
        self._change(state="running", started_utc=datetime.now(UTC))

    def tell(self, progress: float, doing: str) -> None:
        """How far it is, and what it is doing."""
        self._change(progress=progress, doing=doing)

    def succeed(self, files: list[str]) -> None:
        """It has succeeded, and has written these files."""
        self._change(
            state="succeeded", progress=1.0, doing="", files=tuple(sorted(files)), ended_utc=datetime.now(UTC)
        )

    def fail(self, problem: Problem) -> None:
        """It ended in a problem."""
        self.error = problem.document()
        self._change(state="failed", doing="", ended_utc=datetime.now(UTC))

    def cancel(self) -> None:
        """Somebody cancelled it."""
        self._change(state="cancelled", doing="", ended_utc=datetime.now(UTC))

    def _change(self, **values: Any) -> None:
        self._summary = self._summary.model_copy(update=values)
