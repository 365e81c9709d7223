"""Liveness and readiness, for whatever watches the daemon."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel
from starlette.responses import Response

from hapticd_api.dependencies import StationDep

router = APIRouter(tags=["health"])


class Liveness(BaseModel):
    """The daemon answers."""

    status: Literal["alive"] = "alive"


class Readiness(BaseModel):
    """Whether the daemon can do its work, and the checks that fail."""

    ready: bool
    failing: list[str]


@router.get("/livez", operation_id="get_livez", summary="Is the daemon alive?")
def get_livez() -> Liveness:
    """Answers 200 as long as the event loop runs."""
    return Liveness()


@router.get(
    "/readyz",
    operation_id="get_readyz",
    summary="Can the daemon do its work?",
    response_model=Readiness,
    responses={503: {"description": "Not ready; `failing` says why", "model": Readiness}},
)
def get_readyz(station: StationDep) -> Response:
    """Answers 200 when every device is online and every check holds, else 503 with the failing checks."""
    failing = station.ready()
    readiness = Readiness(ready=not failing, failing=[str(check) for check in failing])
    return Response(
        readiness.model_dump_json(), status_code=503 if failing else 200, media_type="application/json"
    )
