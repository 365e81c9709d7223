"""The keys of a device model, with what its file says about each: unit, range, source."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from hapticd.experiments.unit import unit_of
from hapticd.model import DEVICES_DIR

IDENTITY = frozenset({"name", "dof", "type"})

_TABLE = re.compile(r"^\[([^\[\]]+)\]\s*(?:#\s*(.*))?$")
_ENTRY = re.compile(r"^([A-Za-z0-9_-]+)\s*=\s*(?:\"[^\"]*\"|[^#\"])*(?:#\s*(.*))?$")
_RANGE = re.compile(r"\brange\s+(-?[\d.]+)\s*…\s*(-?[\d.]+)")


@dataclass(frozen=True, slots=True)
class ModelKey:
    """One value of a device model.

    ``source`` is the comment in the model's file, its own or that of its table; ``low`` and ``high`` are the
    range that the comment gives: what is plausible, not what is allowed.
    """

    name: str
    default: Any
    unit: str
    source: str
    low: float | None = None
    high: float | None = None


@cache
def model_keys(model: str) -> Mapping[str, ModelKey]:
    """Every dotted key of a model that comes with hapticd, in the order of its file.

    What says which device it is, is left out: it is no parameter.
    """
    text = (DEVICES_DIR / f"{model}.toml").read_text(encoding="utf-8")
    comments = dict(_comments(text))
    return {
        name: _key(name, default, comments.get(name, ""))
        for name, default in _leaves(tomllib.loads(text))
        if name.rpartition(".")[2] not in IDENTITY
    }


def keys_of_model(values: Mapping[str, Any], model: str, models: Sequence[str]) -> dict[str, Any]:
    """Those of ``values`` that belong to ``model``, by dotted key.

    A key may name its model, as in ``hhd:twin.motor.lag_scale``; one that does not belongs to every model
    that has it.
    """
    found: dict[str, Any] = {}
    for name, value in values.items():
        owner, key = split_key(name, models)
        if owner == model or (owner is None and key in model_keys(model)):
            found[key] = value
    return found


def split_key(name: str, models: Sequence[str]) -> tuple[str | None, str]:
    """The model that a key names, if any, and the dotted key itself."""
    prefix, colon, key = name.partition(":")
    return (prefix, key) if colon and prefix in models else (None, name)


def _key(name: str, default: Any, comment: str) -> ModelKey:
    span = _RANGE.search(comment)
    low, high = (float(span[1]), float(span[2])) if span else (None, None)
    return ModelKey(name, default, unit_of(name.rpartition(".")[2]), comment, low, high)


def _comments(text: str) -> Iterator[tuple[str, str]]:
    """Every dotted key with the comment on its line, else that on the line of its table."""
    table, about_table = "", ""
    for line in text.splitlines():
        if header := _TABLE.match(line):
            table = f"{header[1].strip()}."
            about_table = f"[{header[1].strip()}] {header[2].strip()}" if header[2] else ""
        elif entry := _ENTRY.match(line):
            yield table + entry[1], (entry[2] or about_table).strip()


def _leaves(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value
