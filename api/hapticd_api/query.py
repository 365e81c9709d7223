"""Query parameters that nobody knows are refused: a misspelt `dry_run` must not become a write."""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from fastapi import Request
from fastapi.dependencies.models import Dependant

from hapticd.problem import Problem


async def refuse_unknown_query(request: Request) -> None:
    """A dependency of every route. Raises `Problem` (unknown-field), which names the parameter."""
    if not request.query_params:
        return
    known = set(_names(request.scope["route"].dependant))
    for name in request.query_params:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"Did you mean {close[0]!r}? Otherwise leave it out." if close else None
            detail = f"There is no query parameter {name!r} here."
            raise Problem("unknown-field", detail, hint=hint, allowed=sorted(known))


def _names(dependant: Dependant) -> Iterator[str]:
    yield from (parameter.alias for parameter in dependant.query_params)
    for dependency in dependant.dependencies:
        yield from _names(dependency)
