"""One run of an experiment: what it is set to, and what it may use."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from hapticd.experiments.experiment import Experiment, Value
from hapticd.experiments.parallel import parallel_map
from hapticd.experiments.progress import Progress
from hapticd.experiments.settings import Settings, layered
from hapticd.model import Model, load_model
from hapticd.problem import Problem
from hapticd.twin import TwinRun

Item = TypeVar("Item")
Result = TypeVar("Result")


class Run:
    """One run. Equal experiment, settings and seed: equal results to the last digit."""

    def __init__(
        self,
        experiment: Experiment,
        settings: Settings,
        seed: int = 1,
        *,
        progress: Progress | None = None,
        state_dir: Path | None = None,
    ) -> None:
        self.experiment = experiment
        self.settings = settings
        self.seed = seed
        self._state_dir = state_dir
        self._progress = progress or Progress()

    @property
    def state_dir(self) -> Path | None:
        """Where a resumable experiment keeps partial results; None when nothing shall be kept."""
        if self._state_dir is not None:
            self._state_dir.mkdir(parents=True, exist_ok=True)
        return self._state_dir

    @property
    def parameters(self) -> Mapping[str, Value]:
        """Every parameter of the experiment, resolved and range-checked."""
        return self.settings.parameters

    def number(self, name: str) -> float:
        """The value of a parameter that is a number."""
        value = self.parameters[name]
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise TypeError(f"The parameter {name} is {value!r}, not a number.")
        return float(value)

    def integer(self, name: str) -> int:
        """The value of a parameter that is a whole number."""
        value = self.parameters[name]
        if isinstance(value, bool) or not isinstance(value, int):
            raise TypeError(f"The parameter {name} is {value!r}, not a whole number.")
        return value

    def flag(self, name: str) -> bool:
        """The value of a parameter that is true or false."""
        value = self.parameters[name]
        if not isinstance(value, bool):
            raise TypeError(f"The parameter {name} is {value!r}, not true or false.")
        return value

    def word(self, name: str) -> str:
        """The value of a parameter that is a word."""
        value = self.parameters[name]
        if not isinstance(value, str):
            raise TypeError(f"The parameter {name} is {value!r}, not a word.")
        return value

    def vector(self, name: str) -> tuple[float, ...]:
        """The value of a parameter that is a list of numbers."""
        value = self.parameters[name]
        if not isinstance(value, tuple):
            raise TypeError(f"The parameter {name} is {value!r}, not a list of numbers.")
        return value

    def overrides(self, model: str) -> dict[str, Any]:
        """What differs in a device model: the experiment's overrides, and above them what the user set."""
        return layered(self.experiment, self.settings, model)

    def model(self, model: str, overrides: Mapping[str, Any] | None = None) -> Model:
        """A device model as this run has it. ``overrides`` go above the experiment's, below the user's.

        ``Problem`` (parameter-invalid) where they do not go together.
        """
        between = {**self.overrides(model), **(overrides or {}), **self.settings.overrides.get(model, {})}
        try:
            return load_model(model, between)
        except ValueError as error:
            detail = f"{self.experiment.name} cannot be run with these settings: {error}"
            hint = f"hapticd experiment show {self.experiment.name} gives each key's unit, default and range."
            raise Problem("parameter-invalid", detail, hint=hint) from error

    def twin(
        self,
        model: str,
        *,
        rate_hz: float = 1000.0,
        seed: int | None = None,
        overrides: Mapping[str, Any] | None = None,
    ) -> TwinRun:
        """A twin as this run has it, seeded by the run unless ``seed`` says otherwise."""
        return TwinRun(
            self.model(model, overrides), rate_hz=rate_hz, seed=self.seed if seed is None else seed
        )

    def rng(self, purpose: str = "") -> np.random.Generator:
        """Random numbers from the seed; each purpose has its own, whatever the others draw."""
        return np.random.default_rng([self.seed, zlib.crc32(purpose.encode())])

    def progress(self, fraction: float, doing: str) -> None:
        """Tells how far the run is, 0…1. ``Cancelled`` once nobody wants it."""
        self._progress.tell(fraction, doing)

    def map(
        self,
        function: Callable[[Item], Result],
        items: Iterable[Item],
        *,
        doing: str = "simulating",
        until: float = 1.0,
    ) -> list[Result]:
        """``function`` of every item, on all cores, in their order. Progress rises to ``until``.

        Deterministic where ``function`` depends on its item alone. ``Cancelled`` once nobody wants the run.
        """
        begin = self._progress.fraction

        def each(done: int, total: int) -> None:
            self._progress.tell(begin + (until - begin) * done / total, f"{doing}, {done} of {total}")

        return parallel_map(function, items, each)
