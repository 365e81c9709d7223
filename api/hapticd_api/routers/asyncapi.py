"""The description of the WebSockets."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

import orjson
from fastapi import APIRouter

router = APIRouter(tags=["system"])


@cache
def _document() -> dict[str, Any]:
    document: dict[str, Any] = orjson.loads(files("hapticd_api").joinpath("asyncapi.json").read_bytes())
    return document


@router.get("/asyncapi.json", operation_id="get_asyncapi", summary="AsyncAPI document")
def get_asyncapi() -> dict[str, Any]:
    """Messages and close codes of both WebSockets, in AsyncAPI 3."""
    return _document()
