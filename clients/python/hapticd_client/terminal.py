"""What the commands share: their common options, how a document is printed and how an error is shown."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from hapticd_client.client import Client
from hapticd_client.connection import DEFAULT_URL, URL_VARIABLE
from hapticd_client.documents import Interlock, State
from hapticd_client.error import HapticdError, Refused

EXIT_REFUSED = 1
EXIT_UNREACHABLE = 3
"""Exit codes; 2 is a wrong command line."""

UrlOption = Annotated[
    str | None,
    typer.Option("--url", envvar=URL_VARIABLE, help=f"Address of the daemon [default: {DEFAULT_URL}]"),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON, for programs")]
DeviceArgument = Annotated[str, typer.Argument(metavar="DEVICE", help="Id of a device")]
DryRunOption = Annotated[bool, typer.Option("--dry-run", help="Check and predict, change nothing")]

STATE_STYLES: dict[State, str] = {
    "offline": "red",
    "disabled": "default",
    "enabled": "bold green",
    "paused": "yellow",
    "fault": "bold red",
}

HINTS = {
    "wall-exists": "Replace the wall with --replace, or choose another id.",
    "device-not-found": "'hapticd status' lists the devices there are.",
    "wall-not-found": "'hapticd walls list' lists the walls there are.",
    "fault-not-found": "'hapticd status' lists the faults there are.",
    "revision-stale": "Run the command again: somebody else has just edited the scene.",
}
"""Cures in the words of the command line, where the API's are about requests."""

console = Console(highlight=False)
error_console = Console(stderr=True, highlight=False)


@contextmanager
def daemon(url: str | None, *, as_json: bool) -> Iterator[Client]:
    """A client of the daemon; what goes wrong is reported and ends the command."""
    with reported(as_json=as_json), Client(url) as client:
        yield client


@contextmanager
def reported(*, as_json: bool) -> Iterator[None]:
    """Shows a `HapticdError` to the person or, as JSON, to the program, and ends the command."""
    try:
        yield
    except HapticdError as error:
        if as_json:
            print(json.dumps(error.document(), indent=2, ensure_ascii=False), file=sys.stderr)
        else:
            show_error(error)
        raise typer.Exit(EXIT_REFUSED if isinstance(error, Refused) else EXIT_UNREACHABLE) from None


def print_json(document: Any) -> None:
    """Prints a document for programs: no colour, no wrapping."""
    print(json.dumps(document, indent=2, ensure_ascii=False))


def show_error(error: HapticdError) -> None:
    """Title, what happened, and what to do about it."""
    title = error.title if isinstance(error, Refused) else "No answer from hapticd"
    error_console.print(f"[bold red]✗ {escape(title)}[/]")
    error_console.print(f"  {escape(str(error))}", soft_wrap=True)
    if isinstance(error, Refused):
        _show_interlocks([entry for entry in error.interlocks if not entry.get("ok", False)])
    hint = HINTS.get(error.slug, error.hint) if isinstance(error, Refused) else error.hint
    if hint:
        error_console.print(f"  [bold]Cure:[/] {escape(hint)}", soft_wrap=True)


def _show_interlocks(interlocks: list[Interlock]) -> None:
    for interlock in interlocks:
        line = (
            f"  • [bold]{escape(interlock['id'])}[/]: {escape(interlock['why'])} {escape(interlock['cure'])}"
        )
        error_console.print(line, soft_wrap=True)


def state_text(state: State, *, estop: bool) -> str:
    """The state in its colour; a latched emergency stop takes its place."""
    return "[bold white on red] E-STOP [/]" if estop else f"[{STATE_STYLES.get(state, 'default')}]{state}[/]"


def millimetres(vector_m: list[float] | None) -> str:
    """A position for people: millimetres, aligned."""
    if vector_m is None:
        return "–"
    return " ".join(f"{1e3 * coordinate:6.1f}" for coordinate in vector_m)


def norm_text(vector: list[float] | None) -> str:
    """The length of a vector for people."""
    if vector is None:
        return "–"
    return f"{sum(component**2 for component in vector) ** 0.5:.2f}"
