"""The command line: `run` and `doctor` are here, the others come by entry point.

A package adds commands by naming a ``typer.Typer`` in the entry point group ``hapticd.commands``. What a
command needs is imported inside it, so that the others start without it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from importlib.metadata import entry_points, version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.markup import escape

if TYPE_CHECKING:
    from hapticd.doctor import Finding
    from hapticd.problem import Problem

GROUP = "hapticd.commands"
DAEMON = "The daemon"
MARKS = {"ok": "[green]✓[/]", "warn": "[yellow]![/]", "fail": "[bold red]✗[/]"}

ConfigOption = Annotated[
    Path | None,
    typer.Option(
        "--config", metavar="FILE", help="Configuration; else $HAPTICD_CONFIG, else twins of both devices"
    ),
]
TwinOption = Annotated[bool, typer.Option("--twin", help="Twins in place of the configured hardware")]
PortOption = Annotated[
    int | None, typer.Option("--port", min=0, max=65535, help="Port in place of the configured")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON, for programs")]

app = typer.Typer(
    no_args_is_help=True, pretty_exceptions_enable=False, context_settings={"max_content_width": 100}
)
console = Console(highlight=False)
error_console = Console(stderr=True, highlight=False)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(version("hapticd"))
        raise typer.Exit


VersionOption = Annotated[
    bool, typer.Option("--version", help="Print the version", is_eager=True, callback=_print_version)
]


@app.callback()
def hapticd(_: VersionOption = False) -> None:
    """The service that owns haptic devices: walls over HTTP, every tick streamed."""


@app.command(rich_help_panel=DAEMON)
def run(config: ConfigOption = None, twin: TwinOption = False, port: PortOption = None) -> None:
    """Start the daemon and serve the configured devices. Ctrl-C fades forces out and stops it."""
    from hapticd.config import load_config
    from hapticd.daemon import run as serve

    with reported():
        loaded = load_config(config)
        loaded = loaded.on_twins() if twin else loaded
        if port is not None:
            loaded = loaded.model_copy(update={"api": loaded.api.model_copy(update={"port": port})})
        serve(loaded)


@app.command(rich_help_panel=DAEMON)
def doctor(config: ConfigOption = None, as_json: JsonOption = False) -> None:
    """Examine installation, configuration and machine; name what is wrong and what cures it."""
    from hapticd.doctor import Verdict, examine

    findings = list(examine(config))
    if as_json:
        print(json.dumps([asdict(finding) for finding in findings], indent=2, ensure_ascii=False))
    else:
        for finding in findings:
            _show(finding)
    raise typer.Exit(any(finding.verdict is Verdict.FAIL for finding in findings))


def main() -> None:
    """Runs the command line with the commands of every installed package."""
    add_commands(app)
    app()


def add_commands(to: typer.Typer) -> None:
    """Adds the commands of every installed package; one that is broken is reported and left out."""
    for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name):
        try:
            to.add_typer(entry.load())
        except Exception as error:  # a foreign package may raise anything at import
            error_console.print(
                f"[yellow]![/] The commands of {escape(entry.value)} are missing: {escape(repr(error))}"
            )


@contextmanager
def reported(*, as_json: bool = False) -> Iterator[None]:
    """Shows a problem as title, what happened, and cure, or as its document, and ends the command."""
    from hapticd.problem import Problem

    try:
        yield
    except Problem as problem:
        if as_json:
            print(json.dumps(problem.document(), indent=2, ensure_ascii=False), file=sys.stderr)
        else:
            _show_problem(problem)
        raise typer.Exit(1) from None


def _show_problem(problem: Problem) -> None:
    error_console.print(f"[bold red]✗ {escape(problem.title)}[/]")
    error_console.print(f"  {escape(problem.detail)}", soft_wrap=True)
    error_console.print(f"  [bold]Cure:[/] {escape(problem.hint)}", soft_wrap=True)


def _show(finding: Finding) -> None:
    line = f"{MARKS[finding.verdict]} [bold]{escape(finding.subject)}[/]  {escape(finding.detail)}"
    console.print(line, soft_wrap=True)
    if finding.cure is not None:
        console.print(f"    [bold]Cure:[/] {escape(finding.cure)}", soft_wrap=True)
