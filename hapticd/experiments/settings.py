"""What a run of an experiment is set to, and how that is read from ``--set``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

from hapticd.experiments.experiment import Experiment, Value
from hapticd.experiments.model_keys import keys_of_model, model_keys, split_key
from hapticd.experiments.parameter_value import checked_value, refused, typed_like
from hapticd.model import load_model
from hapticd.problem import Problem, json_pointer


@dataclass(frozen=True)
class Settings:
    """Every parameter resolved. ``overrides`` are what the user set in each device model, by dotted key."""

    parameters: Mapping[str, Value]
    overrides: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)


def resolve(experiment: Experiment, values: Mapping[str, Any]) -> Settings:
    """The settings of a run in which ``values`` are set by name.

    A name is a parameter of the experiment or a dotted key of its device models. ``Problem``:
    parameter-unknown lists the known names; parameter-invalid says what the value must be.
    """
    own = {parameter.name: parameter for parameter in experiment.parameters}
    parameters = {name: parameter.default for name, parameter in own.items()}
    overrides: dict[str, dict[str, Value]] = {model: {} for model in experiment.models}
    for name, value in values.items():
        if name in own:
            parameters[name] = checked_value(own[name], value)
            continue
        for model, key in _places(experiment, name):
            overrides[model][key] = _model_value(model, name, key, value)
    settings = Settings(parameters, overrides)
    _check_models(experiment, settings)
    return settings


def known_names(experiment: Experiment) -> list[str]:
    """Every name that can be set: the experiment's own, then the keys of its models."""
    keys = [key for model in experiment.models for key in model_keys(model)]
    return own_names(experiment) + list(dict.fromkeys(keys))


def own_names(experiment: Experiment) -> list[str]:
    """The names of the experiment's own parameters."""
    return [parameter.name for parameter in experiment.parameters]


def layered(experiment: Experiment, settings: Settings, model: str) -> dict[str, Any]:
    """What differs in a model: the experiment's overrides, and above them what the user set."""
    return {
        **keys_of_model(experiment.overrides, model, experiment.models),
        **settings.overrides.get(model, {}),
    }


def _places(experiment: Experiment, name: str) -> list[tuple[str, str]]:
    """Every model that has this key, with the key. ``Problem`` (parameter-unknown) when none has."""
    owner, key = split_key(name, experiment.models)
    models = experiment.models if owner is None else (owner,)
    places = [(model, key) for model in models if key in model_keys(model)]
    if not places:
        raise _unknown(experiment, name)
    return places


def _unknown(experiment: Experiment, name: str) -> Problem:
    known = known_names(experiment)
    close = get_close_matches(name, known, n=3) or [entry for entry in known if name in entry][:3]
    nearest = f" Nearest: {', '.join(close)}." if close else ""
    return Problem(
        "parameter-unknown",
        f"{experiment.name} has no parameter {name!r}.{nearest} Known: {', '.join(known)}.",
        hint=f"hapticd experiment show {experiment.name} explains each.",
        pointer=json_pointer(("set", name)),
        allowed=known,
    )


def _model_value(model: str, name: str, key: str, value: Any) -> Value:
    default = model_keys(model)[key].default
    try:
        return typed_like(default, value)
    except ValueError as error:
        raise refused(name, value, f"it must be {error}; {model} has {default}") from None


def _check_models(experiment: Experiment, settings: Settings) -> None:
    """Has the core check every model that was changed. ``Problem`` (parameter-invalid)."""
    for model, changed in settings.overrides.items():
        if not changed:
            continue
        try:
            load_model(model, layered(experiment, settings, model))
        except ValueError as error:
            names = ", ".join(changed)
            raise Problem(
                "parameter-invalid", f"The model does not work with {names} so: {error}."
            ) from error
