"""The OpenAPI document: what FastAPI derives from the routes, with every error as a problem document."""

from __future__ import annotations

import threading
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel, Field
from starlette.responses import JSONResponse

from hapticd_api.problem_response import MEDIA_TYPE, problem_answers

_TAGS = {
    "devices": "The configured devices and their numbers.",
    "state": "Enabling, and what keeps a device from it.",
    "estop": "The emergency stop. It never needs a lease or a body.",
    "faults": "Latched faults, each with its cause and cure.",
    "scene": "Everything one device renders, replaced whole.",
    "walls": "The walls of a scene, one by one.",
    "analysis": "What a device can render: stability and stiffness. Nothing is changed.",
    "twin": "What only a simulated device has.",
    "experiments": "The figures of the papers, checked on the twins or on a device.",
    "jobs": "Slow work: one job runs, the others wait.",
    "events": "What happened.",
    "system": "The daemon itself, and how well its loops keep time.",
    "health": "For whatever watches the daemon.",
    "problems": "What each kind of error means.",
}

_DESCRIPTION = """Real-time haptic devices over HTTP. SI units, the unit in the name, angles in radians.

* Errors are `application/problem+json`; their `type` leads to a page with cause and cure.
* Unknown fields are refused. Numbers are finite.
* A scene's revision is its `ETag`: send it back in `If-Match` and a stale edit answers 412.
* `?dry_run=true` validates and changes nothing.
* A write that reached the loop says at which tick: `applied`.
* Ticks come over WebSockets, described in [/asyncapi.json](/asyncapi.json).
"""


_IDEMPOTENCY_KEY = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "schema": {"type": "string"},
    "description": "Marks this request: sent again with the same key, it is carried out once",
}


class FieldError(BaseModel):
    """One offending field of a refused document."""

    pointer: str = Field(description="JSON pointer of the field", examples=["/shape/normal"])
    message: str
    kind: str


class ProblemDocument(BaseModel):
    """What went wrong, why, and what to do about it (RFC 9457)."""

    type: str = Field(description="Address of the page about this kind of problem")
    title: str
    status: int
    detail: str = Field(description="What happened this time")
    hint: str = Field(description="What cures it")
    pointer: str | None = Field(None, description="JSON pointer of the offending field")
    device_id: str | None = None
    current_state: str | None = None
    allowed: list[str] | None = Field(None, description="What would have been accepted")
    retryable: bool = Field(description="Whether the same request may succeed later")
    interlocks: list[dict[str, Any]] | None = Field(None, description="Open interlocks of a refused state")
    errors: list[FieldError] | None = Field(None, description="Every offending field")


router = APIRouter(include_in_schema=False)
_building = threading.Lock()


# Not a coroutine: building the document takes half a second, in which the event loop must go on.
@router.get("/openapi.json")
def get_document(request: Request) -> JSONResponse:
    """The document, built when it is first asked for."""
    app: FastAPI = request.app
    with _building:
        if app.openapi_schema is None:
            app.openapi_schema = _finished(app)
    return JSONResponse(app.openapi_schema)


def _finished(app: FastAPI) -> dict[str, Any]:
    document = get_openapi(
        title=app.title,
        version=app.version,
        description=_DESCRIPTION,
        routes=app.routes,
        tags=[{"name": name, "description": text} for name, text in _TAGS.items()],
    )
    schemas = document["components"]["schemas"]
    definition = ProblemDocument.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas.update(definition.pop("$defs"))
    schemas["ProblemDocument"] = definition
    schemas.pop("HTTPValidationError", None)
    schemas.pop("ValidationError", None)
    for path in document["paths"].values():
        for verb, operation in path.items():
            _replace_validation_error(operation)
            _add_general_answers(verb, operation)
    return document


def _add_general_answers(verb: str, operation: dict[str, Any]) -> None:
    """What the middleware may answer to any request of this kind."""
    slugs = ["host-not-allowed"]
    if verb != "get":
        slugs += ["origin-not-allowed", "body-too-large", "unsupported-media-type"]
    if "requestBody" in operation:
        slugs.append("malformed-json")
    if verb == "post":
        slugs.append("idempotency-key-reused")
        operation.setdefault("parameters", []).append(_IDEMPOTENCY_KEY)
    for status, answer in problem_answers(*slugs).items():
        operation["responses"].setdefault(str(status), answer)


def _replace_validation_error(operation: dict[str, Any]) -> None:
    """Puts the problem document where FastAPI assumes its own form of a validation error."""
    answer = operation["responses"].get("422")
    if answer is not None and "application/json" in answer["content"]:
        schema = {"$ref": "#/components/schemas/ProblemDocument"}
        operation["responses"]["422"] = {
            "description": "`invalid-document`: a parameter or the body is not valid",
            "content": {MEDIA_TYPE: {"schema": schema}},
        }
