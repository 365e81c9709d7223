"""Where in a document an error lies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def path_in(document: Any, loc: Sequence[str | int]) -> tuple[str | int, ...]:
    """The path into `document` that pydantic's `loc` means.

    In a tagged union pydantic puts the tag's value into the location, where the document has no such level;
    those steps are left out. A last step that is not in the document stays: it is the field that is missing.
    """
    path: list[str | int] = []
    here = document
    for index, step in enumerate(loc):
        last = index == len(loc) - 1
        if _has(here, step):
            here = here[step]
            path.append(step)
        elif last and not _is_tag(here, step):
            path.append(step)
    return tuple(path)


def _has(document: Any, step: str | int) -> bool:
    if isinstance(document, dict):
        return step in document
    return isinstance(document, list) and isinstance(step, int) and step < len(document)


def _is_tag(document: Any, step: str | int) -> bool:
    return not isinstance(document, dict) or document.get("type") == step
