"""Experiments and their parameters as text for people."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hapticd.experiments.description import ExperimentDescription, ParameterDescription
from hapticd.experiments.parameter_value import shown

Row = tuple[str, str, str, str]
"""Name, default with unit, range, and what is known about it."""


def description_lines(description: ExperimentDescription) -> Iterator[str]:
    """What ``experiment show`` prints."""
    where = "on its twin and on a device (--device)" if description.on_device else "on its twin"
    yield f"{description.name}: {description.title}"
    yield f"{description.source}; runs {where}."
    own = [parameter for parameter in description.parameters if parameter.model is None]
    if own:
        yield ""
        yield "Parameters (~ marks what the papers leave open, which --jitter varies)"
        yield from _aligned([_row(parameter) for parameter in own])
    for model in description.models:
        keys = [parameter for parameter in description.parameters if parameter.model == model]
        yield ""
        yield f"Keys of the device {model} and its twin (the range is what is plausible, not a limit)"
        yield from _aligned([_row(parameter) for parameter in keys])


def _row(parameter: ParameterDescription) -> Row:
    unit = "" if parameter.unit in ("", "1") else f" {parameter.unit}"
    facts = [parameter.meaning.rstrip("."), parameter.source]
    return (
        f"{'~' if parameter.uncertain else ' '} {parameter.name}",
        f"{shown(parameter.default)}{unit}",
        _range(parameter),
        "; ".join(fact for fact in facts if fact),
    )


def _range(parameter: ParameterDescription) -> str:
    if parameter.choices:
        return "|".join(parameter.choices)
    low, high = parameter.minimum, parameter.maximum
    if low is None and high is None:
        return ""
    return f"{'' if low is None else f'{low:g}'}…{'' if high is None else f'{high:g}'}"


def _aligned(rows: Sequence[Row]) -> Iterator[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for row in rows:
        padded = [cell.ljust(width) for cell, width in zip(row, widths, strict=False)]
        yield "  ".join([*padded, row[3]]).rstrip()
