"""The document of a run: what was done, what came out, and what that says about the paper."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from hapticd.experiments.experiment import Claim, Experiment, Outcome
from hapticd.experiments.jitter import Tally
from hapticd.experiments.plain import plain
from hapticd.experiments.settings import Settings, layered


def document(
    experiment: Experiment,
    settings: Settings,
    seed: int,
    outcome: Outcome,
    *,
    device_id: str | None = None,
    tallies: Sequence[Tally] = (),
) -> dict[str, Any]:
    """The JSON document of a run. Equal runs: equal documents.

    ``device_id`` is the device it ran on, if it was not a twin of its own; ``tallies`` say how often each
    claim held under jitter.
    """
    report: dict[str, Any] = {
        "experiment": experiment.name,
        "title": experiment.title,
        "source": experiment.source,
        "parameters": plain(_parameters(experiment, settings)),
        "seed": seed,
        "results": plain(outcome.results),
        "claims": [_claim(claim) for claim in outcome.claims],
    }
    if device_id is not None:
        report["device_id"] = device_id
    if tallies:
        report["jitter"] = [tally.document() for tally in tallies]
    return report


def text(report: Mapping[str, Any]) -> str:
    """The document as it is written to a file, ending in a newline."""
    return json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _parameters(experiment: Experiment, settings: Settings) -> dict[str, Any]:
    """Every parameter of the experiment, and each key of a model that is not as in its file."""
    values: dict[str, Any] = dict(settings.parameters)
    for model in experiment.models:
        prefix = f"{model}:" if len(experiment.models) > 1 else ""
        for key, value in layered(experiment, settings, model).items():
            values[prefix + key] = value
    return values


def _claim(claim: Claim) -> dict[str, Any]:
    entry = {
        "claim": claim.claim,
        "source": claim.source,
        "expected": claim.expected,
        "measured": claim.measured,
        "verdict": claim.verdict,
    }
    return entry if claim.reason is None else {**entry, "reason": claim.reason}
