"""``hapticd experiment``: the papers' figures from the command line."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from hapticd.cli import JsonOption, console, error_console, reported

EXPERIMENTS = "Experiments"
OUT = Path("results")
PIPE_COLUMNS = 160

app = typer.Typer()
experiment = typer.Typer(no_args_is_help=True, help="The papers' figures, checked on the twins.")
app.add_typer(experiment, name="experiment", rich_help_panel=EXPERIMENTS)

NameArgument = Annotated[str, typer.Argument(metavar="NAME", help="Name of an experiment")]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="A parameter or a key of the twin; may be repeated"),
]
SeedOption = Annotated[int, typer.Option("--seed", min=0, help="Equal seeds give equal results")]
OutOption = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help=f"Where files go; by default {OUT}, with --json nowhere"),
]
DeviceOption = Annotated[
    str | None, typer.Option("--device", metavar="ID", help="Run on this device of the running daemon")
]
UrlOption = Annotated[
    str | None, typer.Option("--url", envvar="HAPTICD_URL", help="Address of the daemon, for --device")
]
JitterOption = Annotated[
    int,
    typer.Option("--jitter", min=0, metavar="N", help="Draw what is uncertain N times by ±10 % as well"),
]


@experiment.command("list")
def list_experiments(as_json: JsonOption = False) -> None:
    """Every experiment, with what it shows and where that is from."""
    from hapticd.experiments.catalogue import CATALOGUE, experiment
    from hapticd.experiments.description import summary

    with reported(as_json=as_json):
        summaries = [summary(experiment(name)) for name in CATALOGUE if _is_there(name)]
    if as_json:
        _print_json([entry.model_dump() for entry in summaries])
        return
    for entry in summaries:
        title = f"[bold]{entry.name:<18}[/] {escape(entry.title)} [dim]{escape(entry.source)}[/]"
        console.print(title, soft_wrap=True)


@experiment.command()
def show(name: NameArgument, as_json: JsonOption = False) -> None:
    """Every parameter that --set reaches, with unit, default, range and source."""
    from hapticd.experiments.catalogue import experiment
    from hapticd.experiments.description import describe
    from hapticd.experiments.listing import description_lines

    with reported(as_json=as_json):
        description = describe(experiment(name))
    if as_json:
        _print_json(description.model_dump())
        return
    for line in description_lines(description):
        print(line)


@experiment.command()
def run(
    name: NameArgument,
    assignments: SetOption = None,
    seed: SeedOption = 1,
    out: OutOption = None,
    as_json: JsonOption = False,
    device: DeviceOption = None,
    url: UrlOption = None,
    jitter: JitterOption = 0,
) -> None:
    """Run an experiment: claims, figure and trace. Verdicts do not change the exit code."""
    from hapticd.experiments.assignment import values_of

    out = OUT if out is None and not as_json else out
    with reported(as_json=as_json):
        values = values_of(name, assignments or ())
        if device is None:
            report, files = _run_here(name, values, seed, out, jitter)
        else:
            request = {"name": name, "set": values, "seed": seed, "device_id": device, "jitter": jitter}
            report, files = _run_there(request, url, out)
    _print_json(report) if as_json else _print_report(report)
    for file in files:
        (error_console if as_json else console).print(f"wrote {escape(str(file))}", soft_wrap=True)


@experiment.command()
def reproduce(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Directory of the documentation")] = Path(
        "docs"
    ),
    draws: Annotated[int, typer.Option("--draws", min=0, help="Draws of ±10 % for every experiment")] = 20,
    seed: SeedOption = 1,
) -> None:
    """Run every experiment, jittered as well, and write reproduction.md with its figures."""
    from hapticd.experiments.progress import Progress
    from hapticd.experiments.progress_bar import progress_bar
    from hapticd.experiments.reproduction import reproduce as write

    with reported(), progress_bar(error_console, "reproduction") as report:
        page = write(out, draws, seed, Progress(report))
    console.print(f"wrote {escape(str(page))}", soft_wrap=True)


def _is_there(name: str) -> bool:
    """Whether the experiment can be imported; says why not, where one needs a library that is missing."""
    from hapticd.experiments.catalogue import experiment

    try:
        experiment(name)
    except ImportError as error:
        error_console.print(f"[yellow]![/] {name} cannot be loaded: {escape(str(error))}", soft_wrap=True)
        return False
    return True


def _run_here(
    name: str, values: Mapping[str, Any], seed: int, out: Path | None, jitter: int
) -> tuple[dict[str, Any], Sequence[Path]]:
    from hapticd.experiments.carry_out import Order, carry_out
    from hapticd.experiments.catalogue import experiment
    from hapticd.experiments.progress import Progress
    from hapticd.experiments.progress_bar import progress_bar
    from hapticd.experiments.settings import resolve
    from hapticd.places import default_state_dir

    chosen = experiment(name)
    state_dir = default_state_dir() / "experiments" / name
    order = Order(chosen, resolve(chosen, values), seed, jitter, out, state_dir)
    with progress_bar(error_console, name) as report:
        finished = carry_out(order, Progress(report))
    return finished.document, finished.files


def _run_there(
    request: Mapping[str, Any], url: str | None, out: Path | None
) -> tuple[dict[str, Any], Sequence[Path]]:
    from hapticd.experiments.daemon_job import DaemonJob
    from hapticd.experiments.progress_bar import progress_bar

    with DaemonJob(request, url) as job:
        with progress_bar(error_console, f"{request['name']} on {request['device_id']}") as report:
            ended = job.wait(report)
        return ended["result"], job.fetch(ended, out) if out else ()


def _print_json(document: Any) -> None:
    print(json.dumps(document, indent=2, ensure_ascii=False))


def _print_report(report: Mapping[str, Any]) -> None:
    from hapticd.experiments.claims_table import claims_table

    console.print(f"[bold]{escape(report['title'])}[/] [dim]{escape(report['source'])}[/]", soft_wrap=True)
    # Where no terminal sets the width, the table is as wide as its sentences need.
    wide = console if console.is_terminal else Console(width=PIPE_COLUMNS, highlight=False)
    wide.print(claims_table(report))
