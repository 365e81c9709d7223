"""``--set name=value`` taken apart."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hapticd.experiments.parameter_value import value_of_text
from hapticd.problem import Problem


def values_of(experiment_name: str, assignments: Iterable[str]) -> dict[str, Any]:
    """The values by name; the last of equal names counts. ``Problem`` (parameter-invalid) without a ``=``."""
    values: dict[str, Any] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not (name.strip() and equals):
            detail = f"--set {assignment} does not say what is set to what."
            hint = f"Write --set NAME=VALUE; hapticd experiment show {experiment_name} lists the names."
            raise Problem("parameter-invalid", detail, hint=hint)
        values[name.strip()] = value_of_text(text.strip())
    return values
