"""An experiment described: every parameter that can be set, with unit, default, range and source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import Field

from hapticd.experiments.experiment import Experiment, Parameter
from hapticd.experiments.model_keys import ModelKey, keys_of_model, model_keys
from hapticd.snapshot import Report

Setting = float | int | bool | str | list[float]


class ParameterDescription(Report):
    """One parameter. The range is what is allowed; for a key of a model, what is plausible."""

    name: str
    model: str | None = Field(description="The device model whose key it is; null for the experiment's own")
    unit: str
    default: Setting
    minimum: float | None
    maximum: float | None
    choices: list[str]
    uncertain: bool = Field(description="Whether the papers leave it open: those are jittered")
    meaning: str
    source: str


class ExperimentSummary(Report):
    """What an experiment is."""

    name: str
    title: str
    source: str
    models: list[str]
    on_device: bool


class ExperimentDescription(ExperimentSummary):
    """What an experiment is, with every parameter that can be set."""

    parameters: list[ParameterDescription]


def summary(experiment: Experiment) -> ExperimentSummary:
    """What the experiment is."""
    return ExperimentSummary(**_facts(experiment))


def describe(experiment: Experiment) -> ExperimentDescription:
    """The experiment with every parameter, its own first, then those of each device model."""
    own = [_own(parameter) for parameter in experiment.parameters]
    return ExperimentDescription(**_facts(experiment), parameters=[*own, *_of_models(experiment)])


def _facts(experiment: Experiment) -> dict[str, Any]:
    return {
        "name": experiment.name,
        "title": experiment.title,
        "source": experiment.source,
        "models": list(experiment.models),
        "on_device": experiment.on_device,
    }


def _own(parameter: Parameter) -> ParameterDescription:
    return ParameterDescription(
        name=parameter.name,
        model=None,
        unit=parameter.unit,
        default=_plain(parameter.default),
        minimum=parameter.minimum,
        maximum=parameter.maximum,
        choices=list(parameter.choices),
        uncertain=parameter.uncertain,
        meaning=parameter.meaning,
        source=parameter.source,
    )


def _of_models(experiment: Experiment) -> Iterator[ParameterDescription]:
    for model in experiment.models:
        changed = keys_of_model(experiment.overrides, model, experiment.models)
        uncertain = keys_of_model(dict.fromkeys(experiment.uncertain), model, experiment.models)
        for name, key in model_keys(model).items():
            yield _of_model(model, key, changed.get(name, key.default), uncertain=name in uncertain)


def _of_model(model: str, key: ModelKey, default: Any, *, uncertain: bool) -> ParameterDescription:
    changed = default != key.default
    source = (
        f"set by the experiment; the model has {_plain(key.default)}: {key.source}" if changed else key.source
    )
    return ParameterDescription(
        name=key.name,
        model=model,
        unit=key.unit,
        default=_plain(default),
        minimum=key.low,
        maximum=key.high,
        choices=[],
        uncertain=uncertain,
        meaning="",
        source=source,
    )


def _plain(value: Any) -> Setting:
    return list(value) if isinstance(value, tuple) else value
