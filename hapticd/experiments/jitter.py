"""How robust the claims are: what nobody knows exactly is drawn at random, and each claim is tried again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hapticd.experiments.experiment import Claim, Experiment, Parameter, Value
from hapticd.experiments.model_keys import keys_of_model, model_keys
from hapticd.experiments.parallel import parallel_map
from hapticd.experiments.progress import Progress
from hapticd.experiments.run import Run
from hapticd.experiments.settings import Settings, layered

SPREAD = 0.1
"""Every uncertain number is multiplied by one from 0.9…1.1, uniformly."""


@dataclass(frozen=True)
class Tally:
    """How often one claim held, failed or could not be decided."""

    claim: str
    source: str
    draws: int
    holds: int
    fails: int
    undecidable: int

    def document(self) -> dict[str, Any]:
        """The tally as JSON."""
        return {
            "claim": self.claim,
            "source": self.source,
            "draws": self.draws,
            "holds": self.holds,
            "fails": self.fails,
            "undecidable": self.undecidable,
        }


def drawn(experiment: Experiment, settings: Settings, seed: int, draw: int) -> Settings:
    """The settings of one draw: every uncertain parameter and model key off by up to ``SPREAD``.

    Zero stays zero, whole numbers, words and switches stay; a parameter stays within its range.
    """
    rng = np.random.default_rng([seed, draw])
    own = {parameter.name: parameter for parameter in experiment.parameters if parameter.uncertain}
    parameters = dict(settings.parameters)
    for name, parameter in own.items():
        parameters[name] = _within(parameter, _spread(parameters[name], rng))
    overrides = {model: dict(settings.overrides.get(model, {})) for model in experiment.models}
    for model, key, value in _uncertain_keys(experiment, settings):
        overrides[model][key] = _spread(value, rng)
    return replace(settings, parameters=parameters, overrides=overrides)


def jitter(
    experiment: Experiment, settings: Settings, seed: int, draws: int, progress: Progress | None = None
) -> list[Tally]:
    """Runs the experiment ``draws`` times, each with its own draw, and counts the verdicts of each claim.

    Every run has the same seed, so that only the draw differs. A claim is told by its words and its source.
    """
    progress = progress or Progress()

    def claims_of(draw: int) -> Sequence[Claim]:
        run = Run(experiment, drawn(experiment, settings, seed, draw), seed, progress=progress.silent())
        return experiment.run(run).claims

    def each(done: int, total: int) -> None:
        progress.tell(done / total, f"jitter, {done} of {total}")

    return _tallies(parallel_map(claims_of, range(draws), each))


def nothing_to_draw(experiment: Experiment) -> bool:
    """Whether nothing about the experiment is uncertain."""
    return not experiment.uncertain and not any(parameter.uncertain for parameter in experiment.parameters)


def _uncertain_keys(experiment: Experiment, settings: Settings) -> Iterator[tuple[str, str, Value]]:
    """Every uncertain key with its model and its present value, in a fixed order."""
    named = dict.fromkeys(experiment.uncertain)
    for model in experiment.models:
        present = layered(experiment, settings, model)
        for key in keys_of_model(named, model, experiment.models):
            yield model, key, present.get(key, model_keys(model)[key].default)


def _spread(value: Any, rng: np.random.Generator) -> Any:
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, list | tuple):
        return tuple(_spread(entry, rng) for entry in value)
    return value * float(rng.uniform(1.0 - SPREAD, 1.0 + SPREAD))


def _within(parameter: Parameter, value: Value) -> Value:
    if isinstance(value, tuple):
        return tuple(_clipped(parameter, entry) for entry in value)
    return value if isinstance(value, bool | int | str) else _clipped(parameter, value)


def _clipped(parameter: Parameter, value: float) -> float:
    low = -np.inf if parameter.minimum is None else parameter.minimum
    high = np.inf if parameter.maximum is None else parameter.maximum
    return float(min(max(value, low), high))


def _tallies(claims_by_draw: Sequence[Sequence[Claim]]) -> list[Tally]:
    verdicts: dict[tuple[str, str], list[str]] = {}
    for claims in claims_by_draw:
        for claim in claims:
            verdicts.setdefault((claim.claim, claim.source), []).append(claim.verdict)
    return [_tally(claim, source, found) for (claim, source), found in verdicts.items()]


def _tally(claim: str, source: str, found: Sequence[str]) -> Tally:
    return Tally(
        claim, source, len(found), found.count("holds"), found.count("fails"), found.count("undecidable")
    )
