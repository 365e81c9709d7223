"""A value for a parameter: read from text, brought to the parameter's type, held against its range."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from hapticd.experiments.experiment import Parameter, Value
from hapticd.problem import Problem, json_pointer


def value_of_text(text: str) -> Any:
    """What ``--set name=text`` means: a number, true, false, a list (``1,2`` or ``[1, 2]``), or a word."""
    for candidate in (text, f"[{text}]"):
        with suppress(json.JSONDecodeError):
            return json.loads(candidate)
    return text


def checked_value(parameter: Parameter, value: Any) -> Value:
    """``value`` in the type of the parameter's default. ``Problem`` (parameter-invalid) says why not."""
    try:
        typed = typed_like(parameter.default, value)
    except ValueError as error:
        raise refused(parameter.name, value, f"it must be {error}", _cure(parameter)) from None
    if isinstance(typed, str):
        if parameter.choices and typed not in parameter.choices:
            known = ", ".join(parameter.choices)
            raise refused(
                parameter.name, value, f"it must be one of {known}", _cure(parameter), parameter.choices
            )
    elif not all(_within(parameter, number) for number in _numbers(typed)):
        raise refused(parameter.name, value, f"it must be {range_of(parameter)}", _cure(parameter))
    return typed


def typed_like(default: Any, value: Any) -> Value:
    """``value`` in the type of ``default``; a list becomes a tuple. ``ValueError`` says what it must be."""
    if isinstance(default, bool):
        if isinstance(value, bool):
            return value
        raise ValueError("true or false")
    if isinstance(default, int | float):
        return _number(value, whole=isinstance(default, int))
    if isinstance(default, str):
        # A word that looks like a number was read as one.
        if isinstance(value, str | int | float) and not isinstance(value, bool):
            return str(value)
        raise ValueError("a word")
    return _vector(value, len(default))


def range_of(parameter: Parameter) -> str:
    """The range in words, empty when there is none."""
    low, high = parameter.minimum, parameter.maximum
    unit = "" if parameter.unit in ("", "1") else f" {parameter.unit}"
    if low is not None and high is not None:
        return f"{low:g}…{high:g}{unit}"
    if low is not None:
        return f"at least {low:g}{unit}"
    return "" if high is None else f"at most {high:g}{unit}"


def refused(
    name: str, value: Any, why: str, hint: str | None = None, allowed: Sequence[str] | None = None
) -> Problem:
    """The problem for a value that a parameter cannot have."""
    pointer = json_pointer(("set", name))
    return Problem(
        "parameter-invalid",
        f"{name} cannot be {value!r}: {why}.",
        hint=hint,
        pointer=pointer,
        allowed=allowed,
    )


def shown(value: Any) -> str:
    """A value as ``--set`` takes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return ",".join(shown(entry) for entry in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _number(value: Any, *, whole: bool) -> float | int:
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if whole:
        if is_number and value == int(value):
            return int(value)
        raise ValueError("a whole number")
    if is_number:
        return float(value)
    raise ValueError("a finite number")


def _vector(value: Any, length: int) -> tuple[float, ...]:
    if isinstance(value, list | tuple) and len(value) == length:
        with suppress(ValueError):
            return tuple(_number(entry, whole=False) for entry in value)
    raise ValueError(f"{length} finite numbers with commas between")


def _numbers(value: Value) -> tuple[float, ...]:
    if isinstance(value, tuple):
        return value
    return () if isinstance(value, bool | str) else (float(value),)


def _within(parameter: Parameter, number: float) -> bool:
    above = parameter.minimum is None or number >= parameter.minimum
    return above and (parameter.maximum is None or number <= parameter.maximum)


def _cure(parameter: Parameter) -> str:
    inside = f" in the range {range_of(parameter)}" if range_of(parameter) else ""
    return f"Set a value{inside}; the default is {parameter.name}={shown(parameter.default)}."
