"""The signals a subscriber may ask for: the fields of the tick record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal

from hapticd import _core
from hapticd.problem import Problem


@dataclass(frozen=True, slots=True)
class Signal:
    """One signal.

    ``shape`` is empty for a scalar, ``(3,)`` for a vector; an axis the device does not have is zero.
    Integers are signed on the wire: "none" is −1 where the record has all ones.
    """

    name: str
    unit: str
    shape: tuple[int, ...]
    kind: Literal["float", "integer"]
    meaning: str


@cache
def signals() -> Mapping[str, Signal]:
    """Every signal by name, in the record's order."""
    return {
        field["name"]: Signal(
            name=field["name"],
            unit=field["unit"],
            shape=() if field["words"] == 1 else (field["words"],),
            kind="float" if field["kind"] == "float" else "integer",
            meaning=field["meaning"],
        )
        for field in _core.tick_schema()
    }


def chosen(names: Sequence[str]) -> tuple[str, ...]:
    """``names`` without repetition. ``Problem`` (signal-unknown) names the first that does not exist."""
    for name in names:
        if name not in signals():
            raise Problem("signal-unknown", f"There is no signal {name!r}.", allowed=list(signals()))
    return tuple(dict.fromkeys(names))
