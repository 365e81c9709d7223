"""The papers' figures as experiments that can be run."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Path
from starlette.responses import Response

from hapticd.experiments.catalogue import CATALOGUE, experiment
from hapticd.experiments.description import ExperimentDescription, ExperimentSummary, describe, summary
from hapticd.job import ExperimentRequest, JobSummary
from hapticd.snapshot import Report
from hapticd_api.dependencies import StationDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/experiments", tags=["experiments"])

_EXAMPLES: dict[str, Any] = {
    "plain": {"summary": "As the paper has it", "value": {"name": "force-direction"}},
    "set": {
        "summary": "Another hand, drawn twenty times by ±10 %",
        "value": {"name": "wall-contact", "set": {"twin.hand.mass_kg": 1.4}, "jitter": 20},
    },
    "device": {
        "summary": "On a device that is enabled, its tip locked",
        "value": {"name": "force-direction", "device_id": "phantom"},
    },
}
_STARTED: dict[int | str, dict[str, Any]] = {
    202: {
        "description": "The job is queued",
        "headers": {"Location": {"description": "Address of the job", "schema": {"type": "string"}}},
    }
}


class ExperimentList(Report):
    """Every experiment, in the order of the papers."""

    experiments: list[ExperimentSummary]


# Not coroutines: importing an experiment takes its time, in which the event loop must go on.
@router.get("", operation_id="list_experiments", summary="All experiments")
def list_experiments() -> ExperimentList:
    """Every experiment, what it shows, and whether it also runs on a device."""
    return ExperimentList(experiments=[summary(experiment(name)) for name in CATALOGUE])


@router.get(
    "/{name}",
    operation_id="get_experiment",
    summary="One experiment",
    responses=problem_answers("experiment-not-found"),
)
def get_experiment(
    name: Annotated[str, Path(description="Name of an experiment", examples=["force-direction"])],
) -> ExperimentDescription:
    """The experiment with every parameter that `set` reaches: unit, default, range, source."""
    return describe(experiment(name))


@router.post(
    "",
    operation_id="run_experiment",
    summary="Run an experiment",
    status_code=202,
    response_model=JobSummary,
    responses={
        **_STARTED,
        **problem_answers(
            "experiment-not-found",
            "invalid-document",
            "unknown-field",
            "parameter-unknown",
            "parameter-invalid",
            "experiment-simulated-only",
            "device-not-found",
            "device-not-enabled",
            "too-many-jobs",
            "storage-failed",
        ),
    },
)
async def run_experiment(
    station: StationDep, request: Annotated[ExperimentRequest, Body(openapi_examples=_EXAMPLES)]
) -> Response:
    """Queues the experiment as a job. On a device, its scene is put back when the job ends."""
    job = await station.jobs.submit(request)
    headers = {"Location": f"/api/v1/jobs/{job.id}"}
    return Response(job.summary().model_dump_json(), 202, headers, media_type="application/json")
