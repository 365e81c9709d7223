"""What is wrong with a configuration, as one problem that names every key."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from difflib import get_close_matches
from pathlib import Path

from pydantic import BaseModel, ValidationError

from hapticd.problem import Problem, json_pointer

Sections = Mapping[str, type[BaseModel]]
"""The model of each table, the file itself under the empty name."""


def config_problem(error: ValidationError, file: Path | None, sections: Sections) -> Problem:
    """The problem for a configuration that its models refused. ``file`` is None when there was none."""
    where = f"{file}: " if file else "From the environment: "
    found = error.errors()
    sentences = [_sentence(entry["loc"], entry["type"], entry["msg"], sections) for entry in found]
    return Problem("config-invalid", where + " ".join(sentences), pointer=json_pointer(found[0]["loc"]))


def nearest(name: str, known: Collection[str]) -> str:
    """A hint at the known name that ``name`` may have meant, with a leading space."""
    matches = get_close_matches(name, known, n=1)
    return f" Did you mean {matches[0]}?" if matches else f" Known: {', '.join(sorted(known))}."


def _sentence(path: tuple[int | str, ...], kind: str, message: str, sections: Sections) -> str:
    key = ".".join(str(part) for part in path)
    if kind == "extra_forbidden":
        table = str(path[0]) if len(path) > 1 else ""
        return f"{key} is not a key.{nearest(str(path[-1]), sections[table].model_fields)}"
    return f"{key}: {message.removeprefix('Value error, ').rstrip('.')}."
