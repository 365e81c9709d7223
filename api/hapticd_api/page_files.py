"""The live page at `/`: plain files of this package."""

from __future__ import annotations

from importlib.resources import files

from fastapi import APIRouter
from starlette.responses import Response

from hapticd.problem import Problem

router = APIRouter(include_in_schema=False)

_PAGE = files("hapticd_api") / "page"
_MEDIA_TYPES = {
    "html": "text/html",
    "js": "text/javascript",
    "css": "text/css",
    "svg": "image/svg+xml",
}


@router.get("/")
def get_page() -> Response:
    """The live page."""
    return _file("index.html")


@router.get("/favicon.ico")
def get_icon() -> Response:
    """The icon, where a browser looks for it unasked."""
    return _file("icon.svg")


@router.get("/page/{name}")
def get_page_file(name: str) -> Response:
    """One of the page's files."""
    return _file(name)


def _file(name: str) -> Response:
    # Only names that the directory lists: no path that a caller makes up is ever opened.
    known = {entry.name: entry for entry in _PAGE.iterdir()}
    media_type = _MEDIA_TYPES.get(name.rpartition(".")[2])
    if name not in known or media_type is None:
        raise Problem("route-not-found", f"The page has no file {name!r}.")
    return Response(known[name].read_bytes(), media_type=media_type)
