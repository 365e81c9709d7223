"""Turns whatever a route raises into a problem document."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from functools import cache
from http import HTTPStatus
from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from hapticd.document import Document
from hapticd.problem import Problem, invalid_document
from hapticd_api.pointer import path_in
from hapticd_api.problem_response import problem_response

_log = structlog.get_logger(__name__)

_SLUG_OF_STATUS = {
    HTTPStatus.BAD_REQUEST: "malformed-json",
    HTTPStatus.NOT_FOUND: "route-not-found",
    HTTPStatus.METHOD_NOT_ALLOWED: "method-not-allowed",
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE: "unsupported-media-type",
}


def install(app: FastAPI) -> None:
    """Makes problem documents of every error that `app` can answer with."""
    app.add_exception_handler(Problem, _on_problem)
    app.add_exception_handler(RequestValidationError, _on_invalid)
    app.add_exception_handler(HTTPException, _on_http)
    app.add_exception_handler(Exception, _on_unforeseen)


async def _on_problem(_: Request, problem: Exception) -> Response:
    assert isinstance(problem, Problem)
    return problem_response(problem)


async def _on_invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    return problem_response(refused_request(error.errors(), error.body))


async def _on_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    slug = _SLUG_OF_STATUS.get(HTTPStatus(error.status_code), "internal-error")
    detail = f"{request.method} {request.url.path}: {error.detail}"
    return problem_response(Problem(slug, detail, allowed=_allowed(error.headers)), error.headers)


async def _on_unforeseen(request: Request, error: Exception) -> Response:
    _log.error("request_failed", method=request.method, path=request.url.path, error=repr(error))
    return problem_response(Problem("internal-error", f"{request.method} {request.url.path} failed."))


def _allowed(headers: Mapping[str, str] | None) -> list[str] | None:
    allow = (headers or {}).get("Allow")
    return None if allow is None else [verb.strip() for verb in allow.split(",")]


def refused_request(errors: Sequence[Mapping[str, Any]], body: Any) -> Problem:
    """The problem for a request that its models refused.

    `errors` is pydantic's list for the whole request, whose `loc` starts with the part of the request;
    `body` is the parsed body, against which pointers are made.
    """
    parts = {str(entry["loc"][0]) for entry in errors}
    if any(entry["type"] == "json_invalid" for entry in errors):
        return _malformed(errors[0])
    if parts != {"body"}:
        return _refused_parameter(next(entry for entry in errors if entry["loc"][0] != "body"))
    if any(tuple(entry["loc"]) == ("body",) and entry["type"] == "missing" for entry in errors):
        return Problem("invalid-document", "The request needs a JSON body and has none.", pointer="")
    return refused_document([{**entry, "loc": entry["loc"][1:]} for entry in errors], body)


def refused_document(errors: Sequence[Mapping[str, Any]], document: Any) -> Problem:
    """The problem for a document that its model refused, each error with its JSON pointer into `document`."""
    placed = [{**entry, "loc": path_in(document, entry["loc"])} for entry in errors]
    problem = invalid_document(placed)
    if problem.slug == "unknown-field":
        _suggest(problem, str(placed[0]["loc"][-1]))
    return problem


def _malformed(entry: Mapping[str, Any]) -> Problem:
    reason = entry.get("ctx", {}).get("error", entry["msg"])
    return Problem("malformed-json", f"The body is not JSON: {reason}, at character {entry['loc'][-1]}.")


def _refused_parameter(entry: Mapping[str, Any]) -> Problem:
    part, name = str(entry["loc"][0]), str(entry["loc"][1])
    slug = "unknown-field" if entry["type"] == "extra_forbidden" else "invalid-document"
    return Problem(slug, f"The {part} parameter {name}: {entry['msg']}.")


def _suggest(problem: Problem, name: str) -> None:
    close = difflib.get_close_matches(name, _field_names(), n=1, cutoff=0.7)
    if close:
        problem.hint = f"Did you mean {close[0]!r}? Otherwise leave the field out."


@cache
def _field_names() -> list[str]:
    """Every field that people may write in any document."""
    names: set[str] = set()
    models = [Document]
    while models:
        model = models.pop()
        names |= set(model.model_fields)
        models += model.__subclasses__()
    return sorted(names)
