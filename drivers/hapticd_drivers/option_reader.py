"""Reads a driver's options strictly: every key is taken, checked, and known, or it is an error."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

from hapticd_drivers.error import OptionError


class OptionReader:
    """Takes options out one by one; whatever is left at the end is an error.

    Every method raises `OptionError` with a message that names the key.
    """

    def __init__(self, options: Mapping[str, Any]) -> None:
        self._left = dict(options)
        self._known: list[str] = []

    def __contains__(self, key: str) -> bool:
        self._known.append(key)
        return key in self._left

    def _take(self, key: str, default: Any = None) -> Any:
        self._known.append(key)
        value = self._left.pop(key, default)
        if value is None:
            raise OptionError(f"{key} is missing")
        return value

    def text(self, key: str) -> str:
        """A text that is not empty."""
        value = self._take(key)
        if not isinstance(value, str) or not value:
            raise OptionError(f"{key} must be a text")
        return value

    def choice(self, key: str, choices: tuple[str, ...]) -> str:
        """One of `choices`; the first where nothing is given."""
        value = self._take(key, choices[0])
        if value not in choices:
            raise OptionError(f"{key} must be one of {', '.join(choices)}")
        return str(value)

    def number(self, key: str, low: float, high: float, default: float) -> float:
        """A number from `low` to `high`."""
        value = self._take(key, default)
        if not _is_number(value) or not low <= value <= high:
            raise OptionError(f"{key} must be a number from {low:g} to {high:g}")
        return float(value)

    def numbers(self, key: str, count: int, default: float | None = None) -> tuple[float, ...]:
        """`count` finite numbers."""
        values = self._take(key, None if default is None else [default] * count)
        if not isinstance(values, list | tuple) or len(values) != count or not all(map(_is_number, values)):
            raise OptionError(f"{key} must be a list of {count} finite numbers")
        return tuple(map(float, values))

    def matrix(self, key: str, rows: int, columns: int) -> tuple[tuple[float, ...], ...]:
        """`rows` rows of `columns` finite numbers."""
        values = self._take(key)
        if not isinstance(values, list | tuple) or len(values) != rows:
            raise OptionError(f"{key} must have {rows} rows")
        return tuple(OptionReader({key: row}).numbers(key, columns) for row in values)

    def channels(
        self, key: str, count: int | None, available: int, default: range | None = None
    ) -> tuple[int, ...]:
        """Channel numbers below `available`, all different; `count` of them, or any number but none."""
        values = self._take(key, None if default is None else list(default))
        if not isinstance(values, list | tuple) or not all(type(value) is int for value in values):
            raise OptionError(f"{key} must be a list of channel numbers")
        wrong_count = len(values) != count if count is not None else not values
        if wrong_count or len(set(values)) != len(values) or not all(0 <= v < available for v in values):
            amount = f"{count} different" if count is not None else "different"
            raise OptionError(f"{key} must be {amount} channels from 0 to {available - 1}")
        return tuple(values)

    def uid(self, key: str) -> bytes | None:
        """A serial number of 8 bytes in hexadecimal; None where nothing is given."""
        value = self._take(key, "")
        try:
            uid = bytes.fromhex(value)
        except (TypeError, ValueError):
            uid = b"?"
        if len(uid) not in (0, 8):
            raise OptionError(f"{key} must be 16 hexadecimal digits")
        return uid or None

    def finish(self) -> None:
        """Refuses whatever nobody took."""
        for key in self._left:
            near = difflib.get_close_matches(key, self._known, 1)
            raise OptionError(f"unknown option {key}" + (f": did you mean {near[0]}?" if near else ""))


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < 1e12
