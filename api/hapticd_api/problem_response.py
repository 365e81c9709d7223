"""Problems as HTTP: every error of the API is one `application/problem+json` document (RFC 9457)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import orjson
from starlette.responses import Response

from hapticd.problem import Problem
from hapticd.problem_types import PROBLEM_TYPES

MEDIA_TYPE = "application/problem+json"


def problem_response(problem: Problem, headers: Mapping[str, str] | None = None) -> Response:
    """The response for `problem`; a retryable one that says 503 carries `Retry-After`."""
    all_headers = dict(headers or {})
    if problem.status == 503 and problem.retryable:
        all_headers.setdefault("Retry-After", "1")
    return Response(
        orjson.dumps(problem.document(), default=str),
        status_code=problem.status,
        headers=all_headers,
        media_type=MEDIA_TYPE,
    )


def problem_answers(*slugs: str) -> dict[int | str, dict[str, Any]]:
    """The error part of a route's OpenAPI `responses`: each slug by its status, with its cause and cure."""
    answers: dict[int | str, dict[str, Any]] = {}
    for slug in slugs:
        kind = PROBLEM_TYPES[slug]
        answer = answers.setdefault(kind.status, _answer())
        answer["description"] = "; ".join(filter(None, [answer["description"], f"`{slug}`: {kind.title}"]))
        answer["content"][MEDIA_TYPE]["examples"][slug] = {"value": Problem(slug, kind.cause).document()}
    return answers


def _answer() -> dict[str, Any]:
    schema = {"$ref": "#/components/schemas/ProblemDocument"}
    return {"description": "", "content": {MEDIA_TYPE: {"schema": schema, "examples": {}}}}
