"""The small experiment in the catalogue."""

from __future__ import annotations

import pytest

from tests.hapticd.experiments.fake_experiment import FakeExperiment, put_alone_into_catalogue


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> FakeExperiment:
    """The small experiment, in the catalogue and alone there."""
    return put_alone_into_catalogue(monkeypatch)
