"""A run from its settings to its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hapticd.experiments.experiment import Experiment, Outcome
from hapticd.experiments.figure_file import write_figure
from hapticd.experiments.jitter import Tally, jitter
from hapticd.experiments.library import check_library
from hapticd.experiments.progress import Progress
from hapticd.experiments.report import document, text
from hapticd.experiments.run import Run
from hapticd.experiments.settings import Settings
from hapticd.experiments.trace_file import write_traces
from hapticd.problem import Problem
from hapticd.twin import Refused


@dataclass(frozen=True)
class Order:
    """What shall be run. ``out`` is where its files go; None: no files.

    ``jitter`` counts the draws, ``of_draws`` are their settings where they are not those of the run.
    """

    experiment: Experiment
    settings: Settings
    seed: int = 1
    jitter: int = 0
    out: Path | None = None
    state_dir: Path | None = None
    of_draws: Settings | None = None


@dataclass(frozen=True)
class Finished:
    """The document of a run, and the files that were written."""

    document: dict[str, Any]
    files: tuple[Path, ...]


def carry_out(order: Order, progress: Progress | None = None) -> Finished:
    """Runs an experiment on its twins. ``Problem``; ``Cancelled``."""
    if order.out is not None:
        check_libraries()
    try:
        return _carry_out(order, progress or Progress())
    except Refused as error:
        detail = f"The twin of {order.experiment.name} did not go along: {error}."
        hint = "Set back what was changed last: in this state the device cannot be enabled."
        raise Problem("experiment-failed", detail, hint=hint) from error


def _carry_out(order: Order, progress: Progress) -> Finished:
    # Each draw costs what the run itself costs.
    own = 1.0 / (1.0 + order.jitter)
    run = Run(
        order.experiment,
        order.settings,
        order.seed,
        progress=progress.part(0.0, own),
        state_dir=order.state_dir,
    )
    outcome = order.experiment.run(run)
    tallies: list[Tally] = []
    if order.jitter:
        settings = order.of_draws or order.settings
        tallies = jitter(order.experiment, settings, order.seed, order.jitter, progress.part(own, 1.0))
    return finish(order, outcome, tallies=tallies)


def finish(
    order: Order, outcome: Outcome, *, device_id: str | None = None, tallies: list[Tally] | None = None
) -> Finished:
    """The document of an outcome, and its files where the order wants them: JSON, figure and traces."""
    report = document(
        order.experiment, order.settings, order.seed, outcome, device_id=device_id, tallies=tallies or ()
    )
    if order.out is None:
        return Finished(report, ())
    order.out.mkdir(parents=True, exist_ok=True)
    stem = order.out / order.experiment.name
    facts = {
        "experiment": order.experiment.name,
        "title": order.experiment.title,
        "source": order.experiment.source,
        "seed": str(order.seed),
    }
    json_file = stem.with_name(f"{stem.name}.json")
    json_file.write_text(text(report), encoding="utf-8")
    return Finished(report, (json_file, *write_figure(outcome, stem), *write_traces(outcome, stem, facts)))


def check_libraries() -> None:
    """``Problem`` (library-missing) before anything is computed in vain."""
    check_library("matplotlib")
    check_library("pyarrow")
