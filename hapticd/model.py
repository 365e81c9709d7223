"""Device models: one TOML file each, with overrides, as the JSON that the core reads."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from hapticd import _core

DEVICES_DIR = Path(__file__).parent / "devices"
"""Where the models that come with hapticd are."""


@dataclass(frozen=True)
class Model:
    """One device model, checked by the core."""

    name: str
    dof: int
    device_json: str
    """The device: geometry, drives, brakes, limits."""
    twin_json: str
    """What only its twin needs to know; ``null`` when the file has no ``[twin]``."""

    @property
    def has_brakes(self) -> bool:
        """Whether any joint has a brake."""
        return json.loads(self.device_json).get("brakes") is not None

    def changed(self, overrides: Mapping[str, Any]) -> Model:
        """This model with single values replaced, by dotted key. ``ValueError`` as in ``load_model``."""
        document = json.loads(self.device_json)
        if (twin := json.loads(self.twin_json)) is not None:
            document["twin"] = twin
        return _checked(document, overrides, self.name)


def model_names() -> list[str]:
    """Names of the models that come with hapticd."""
    return sorted(path.stem for path in DEVICES_DIR.glob("*.toml"))


def load_model(name_or_path: str | Path, overrides: Mapping[str, Any] | None = None) -> Model:
    """The model of that name, or in that file, with single values replaced.

    ``overrides`` maps dotted keys to values, for example ``{"limits.tip_force_n": 5.0}``. ``OSError``: the
    file cannot be read. ``ValueError``: no such model, no TOML, an unknown key, or a value that makes no
    sense; the message names the key.
    """
    path = _path(name_or_path)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{path}: {error}") from error
    return _checked(document, overrides or {}, path.name)


def _checked(document: dict[str, Any], overrides: Mapping[str, Any], source: str) -> Model:
    """The model in ``document`` under ``overrides``, checked by the core; ``source`` begins the message."""
    for key, value in overrides.items():
        _override(document, key, value)
    twin_json = json.dumps(document.pop("twin", None))
    device_json = json.dumps(document)
    try:
        _core.check_model(device_json, twin_json)
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from error
    return Model(str(document["name"]), int(document["dof"]), device_json, twin_json)


def _path(name_or_path: str | Path) -> Path:
    if isinstance(name_or_path, Path) or name_or_path.endswith(".toml"):
        return Path(name_or_path)
    if name_or_path not in model_names():
        known = ", ".join(model_names())
        raise ValueError(f"There is no model {name_or_path!r}. Models: {known}, or the path of a .toml file.")
    return DEVICES_DIR / f"{name_or_path}.toml"


def _override(document: dict[str, Any], key: str, value: Any) -> None:
    known = dict(_leaves(document))
    if key not in known:
        close = get_close_matches(key, known, n=3) or sorted(known)
        raise ValueError(f"The model has no key {key!r}. Known keys: {', '.join(close)}.")
    table, name = known[key], key.rpartition(".")[2]
    if _shape(value) != _shape(table[name]):
        raise ValueError(f"{key} cannot be {value!r}: the model has {table[name]!r} there.")
    table[name] = value


def _shape(value: Any) -> tuple[str, ...]:
    """What kind of value it is; a whole number is a number like any other, a list has its length."""
    if isinstance(value, list | tuple):
        return ("list", *(kind for entry in value for kind in _shape(entry)))
    if isinstance(value, bool):
        return ("bool",)
    return ("number",) if isinstance(value, int | float) else (type(value).__name__,)


def _leaves(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every dotted key that holds a value, with the table it is in."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", table
