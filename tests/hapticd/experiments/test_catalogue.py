"""Every experiment of the catalogue is what the runner takes it for."""

from __future__ import annotations

import pytest

from hapticd.experiments.bench import DeviceExperiment
from hapticd.experiments.catalogue import CATALOGUE, experiment
from hapticd.experiments.description import describe
from hapticd.experiments.experiment import Parameter
from hapticd.experiments.model_keys import keys_of_model
from hapticd.experiments.reproduction import OF_DRAWS
from hapticd.experiments.settings import resolve
from hapticd.model import model_names


@pytest.mark.parametrize("name", CATALOGUE)
def test_it_has_everything_the_runner_asks_for(name: str) -> None:
    chosen = experiment(name)
    assert chosen.name == name
    assert chosen.title
    assert chosen.source
    assert set(chosen.models) <= set(model_names())
    assert all(isinstance(parameter, Parameter) for parameter in chosen.parameters)
    assert isinstance(chosen, DeviceExperiment) == chosen.on_device
    if isinstance(chosen, DeviceExperiment):
        assert chosen.device_models
        assert set(chosen.device_models) <= set(model_names())
    assert callable(chosen.run)


@pytest.mark.parametrize("name", CATALOGUE)
def test_its_defaults_are_in_their_ranges_and_go_together(name: str) -> None:
    chosen = experiment(name)
    own = {parameter.name: parameter.default for parameter in chosen.parameters}
    assert resolve(chosen, own).parameters == own
    resolve(chosen, OF_DRAWS.get(name, {}))


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_key_that_it_changes_or_draws_is_one_of_its_models(name: str) -> None:
    chosen = experiment(name)
    for key in (*chosen.overrides, *chosen.uncertain):
        assert any(keys_of_model({key: None}, model, chosen.models) for model in chosen.models), key


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_parameter_of_its_own_says_what_it_is_and_whence_its_default(name: str) -> None:
    for parameter in describe(experiment(name)).parameters:
        if parameter.model is None:
            assert parameter.meaning, parameter.name
            assert parameter.source, parameter.name
