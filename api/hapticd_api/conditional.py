"""Answers with an entity tag, and 304 where the caller's copy still holds."""

from __future__ import annotations

from pydantic import BaseModel
from starlette.responses import Response

from hapticd_api.etag import is_fresh


def tagged(document: BaseModel, etag: str, *, status: int = 200, location: str | None = None) -> Response:
    """`document` with its `ETag`, and with the `Location` of what was made."""
    headers = {"ETag": etag} if location is None else {"ETag": etag, "Location": location}
    return Response(document.model_dump_json(), status, headers, media_type="application/json")


def conditional(document: BaseModel, etag: str, if_none_match: str | None) -> Response:
    """`document` with its `ETag`, or 304 when `if_none_match` names it."""
    if is_fresh(if_none_match, etag):
        return Response(status_code=304, headers={"ETag": etag})
    return tagged(document, etag)
