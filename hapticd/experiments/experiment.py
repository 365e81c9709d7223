"""What an experiment is: named parameters in, results, claims, a figure and a trace out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hapticd.experiments.run import Run

Value = float | int | bool | str | tuple[float, ...]
"""A parameter's value. Lengths of tuples are fixed by the default."""

Verdict = Literal["holds", "fails", "undecidable"]


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter of an experiment.

    ``minimum`` and ``maximum`` bound a number, or each component of a tuple; ``choices`` lists the words a
    string may be. ``uncertain`` marks what the papers do not state: those are jittered.
    """

    name: str
    default: Value
    unit: str
    meaning: str
    source: str
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    uncertain: bool = False


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim of a paper, and what was measured. ``reason`` is needed when it is undecidable."""

    claim: str
    source: str
    expected: str
    measured: str
    verdict: Verdict
    reason: str | None = None


@dataclass(frozen=True)
class Outcome:
    """What an experiment found.

    ``results`` holds plain numbers, strings, lists and dicts (JSON); ``figure`` draws into an empty figure;
    ``traces`` are tables by name: structured arrays, or mappings of column name to equally long arrays.
    """

    results: Mapping[str, Any]
    claims: tuple[Claim, ...]
    figure: Callable[[Figure], None]
    traces: Mapping[str, NDArray[Any] | Mapping[str, NDArray[np.float64]]] = field(default_factory=dict)


class Experiment(Protocol):
    """One figure of a paper.

    ``models`` names the device models whose twin and device parameters ``--set`` reaches by dotted key
    (``twin.hand.mass_kg``, ``drive.lag_s``); none for one that is pure mathematics. ``overrides`` are what
    the experiment changes in them, and the defaults that ``show`` prints; ``uncertain`` are the keys that the
    papers leave open, which are jittered like the uncertain parameters. A key may name its model
    (``hhd:twin.hand.mass_kg``), else it means every model that has it. ``on_device`` says whether the
    experiment also runs on a device of a running daemon.
    """

    name: str
    title: str
    source: str
    models: tuple[str, ...]
    overrides: Mapping[str, Any]
    uncertain: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    on_device: bool

    def run(self, run: Run) -> Outcome:
        """Carries it out."""
        ...
