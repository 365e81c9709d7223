"""Jobs: slow work, watched and cancelled."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Path
from starlette.responses import FileResponse

from hapticd.job import Job, JobReport, JobSummary
from hapticd.snapshot import Report
from hapticd_api.dependencies import StationDep
from hapticd_api.problem_response import problem_answers

router = APIRouter(prefix="/api/v1/jobs", tags=["jobs"])

_MEDIA_TYPES = {
    ".json": "application/json",
    ".parquet": "application/vnd.apache.parquet",
    ".png": "image/png",
    ".svg": "image/svg+xml",
}

JobId = Annotated[str, Path(description="Id of a job", examples=["force-direction-5f0c8e1a"])]


async def _job(job_id: JobId, station: StationDep) -> Job:
    return station.jobs.get(job_id)


JobDep = Annotated[Job, Depends(_job)]


class JobList(Report):
    """Every job that is remembered, the newest first."""

    jobs: list[JobSummary]


@router.get("", operation_id="list_jobs", summary="All jobs")
async def list_jobs(station: StationDep) -> JobList:
    """Jobs that wait, run or have ended, without their results."""
    return JobList(jobs=[job.summary() for job in station.jobs.all()])


@router.get(
    "/{job_id}", operation_id="get_job", summary="One job", responses=problem_answers("job-not-found")
)
async def get_job(job: JobDep) -> JobReport:
    """How far the job is; its result once it has succeeded, or the problem that ended it."""
    return job.report()


@router.delete(
    "/{job_id}",
    operation_id="cancel_job",
    summary="Cancel a job",
    responses=problem_answers("job-not-found", "job-ended"),
)
async def cancel_job(job: JobDep, station: StationDep) -> JobReport:
    """Ends the job. A device that it used renders its own scene again when this answers."""
    return (await station.jobs.cancel(job.id)).report()


@router.get(
    "/{job_id}/files/{name}",
    operation_id="get_job_file",
    summary="A file of a job",
    response_class=FileResponse,
    responses={
        200: {"description": "The file", "content": {kind: {} for kind in _MEDIA_TYPES.values()}},
        **problem_answers("job-not-found", "job-file-not-found"),
    },
)
async def get_job_file(
    job: JobDep, name: Annotated[str, Path(description="A name from the job's files")]
) -> FileResponse:
    """Figure, trace or result of a job that has succeeded."""
    file = job.file(name)
    return FileResponse(file, media_type=_MEDIA_TYPES.get(file.suffix, "application/octet-stream"))
