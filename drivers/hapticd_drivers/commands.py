"""Commands that drivers add to `hapticd`."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hapticd_drivers.error import OptionError
from hapticd_drivers.registry import driver_module, driver_names

if TYPE_CHECKING:
    from hapticd_drivers.emulation import Emulation

app = typer.Typer(help="Drivers and their emulators.")

Faults = Annotated[
    str,
    typer.Option(
        help="What is wrong with the cable, with commas: lose=0.01, corrupt=0.01, duplicate=0.01, "
        "reorder=0.01 (fractions), delay=0.002 (s), mute=5+0.5, unplug=10+2 (START+DURATION, s)."
    ),
]


@app.command()
def emulate(
    driver: Annotated[
        str, typer.Argument(help="Driver whose board is emulated.", autocompletion=driver_names)
    ],
    twin: Annotated[str, typer.Option(help="Device model behind the board.")] = "hhd",
    rate: Annotated[int, typer.Option(min=100, max=10_000, help="Tick rate, Hz.")] = 1000,
    pacing: Annotated[str, typer.Option(help="Who keeps the beat in the snippet: host or device.")] = "host",
    faults: Faults = "",
    hand: Annotated[str, typer.Option(help="Task of the operator's hand, JSON.")] = '{"type": "hold"}',
    link: Annotated[Path | None, typer.Option(help="Path that always names the port.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of noise, cable faults and serial number.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="Print one line of JSON.")] = False,
) -> None:
    """Puts a board with a device on a pseudo-terminal, until interrupted.

    Lines of JSON on standard input change it: {"hand": {"type": "follow", "target_m": [0, 0.2, 0]}},
    {"estop": true}, {"faults": "lose=0.1"}.
    """
    try:
        emulation, report = driver_module(driver).emulate(
            twin=twin, rate_hz=rate, pacing=pacing, faults=faults, hand=hand, link=link, seed=seed
        )
    except (OptionError, ValueError, AttributeError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(json.dumps(report) if as_json else _told(report))
    sys.stdout.flush()
    _serve(emulation)


def _serve(emulation: Emulation) -> None:
    stopping: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _frame: stopping.append(number))
    with emulation:
        emulation.run(
            _input_fd(), lambda: bool(stopping), lambda why: typer.echo(f"not done: {why}", err=True)
        )


def _input_fd() -> int | None:
    """Standard input, where there is one to read."""
    try:
        fd = sys.stdin.fileno()
        os.fstat(fd)
    except (OSError, ValueError, AttributeError):
        return None
    return fd


def _told(report: dict[str, Any]) -> str:
    return (
        f"{report['model']} behind {report['driver']} at {report['rate_hz']} Hz: {report['port']}\n\n"
        f"{report['config']}\n"
        "Interrupt with Ctrl-C. Lines of JSON here change the hand, the E-stop input and the cable."
    )
