"""Commands that drivers add to `hapticd`."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from hapticd_drivers.registry import driver_names, emulator

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


@app.command(rich_help_panel="Hardware")
def emulate(
    driver: Annotated[
        str, typer.Argument(help="Driver whose board is emulated.", autocompletion=driver_names)
    ],
    twin: Annotated[str, typer.Option(help="Device model behind the board.")] = "hhd",
    rate: Annotated[int, typer.Option(min=100, max=10_000, help="Tick rate, Hz.")] = 1000,
    pacing: Annotated[
        Literal["device", "host"], typer.Option(help="Who keeps the beat, for the snippet.")
    ] = "device",
    faults: Faults = "",
    hand: Annotated[str, typer.Option(help="Task of the operator's hand, JSON.")] = '{"type": "hold"}',
    link: Annotated[Path | None, typer.Option(help="Path that always names the port.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of noise, cable faults and serial number.")] = 1,
    priority: Annotated[
        int, typer.Option(min=0, max=98, help="SCHED_FIFO priority, where permitted; 0: none.")
    ] = 50,
    as_json: Annotated[bool, typer.Option("--json", help="Print one line of JSON.")] = False,
) -> None:
    """Put a board with a device on a pseudo-terminal, until interrupted.

    Lines of JSON on standard input change it: {"hand": {"type": "follow", "target_m": [0, 0.2, 0]}},
    {"estop": true}, {"faults": "lose=0.1"}.
    """
    try:
        emulation, report = emulator(driver)(
            twin=twin, rate_hz=rate, pacing=pacing, faults=faults, hand=hand, link=link, seed=seed
        )
    except ValueError as error:  # OptionError is one
        raise typer.BadParameter(str(error)) from error
    report["realtime"] = _run_realtime(priority)
    typer.echo(json.dumps(report) if as_json else _told(report))
    sys.stdout.flush()
    _serve(emulation)


def _run_realtime(priority: int) -> bool:
    """Asks for real-time scheduling: a board's clock does not wait for other programs."""
    if priority:
        with contextlib.suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    return os.sched_getscheduler(0) == os.SCHED_FIFO


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
        f"{report['model']} behind {report['driver']} at {report['rate_hz']} Hz: {report['port']}"
        f"{'' if report['realtime'] else ' (no real-time scheduling: expect late frames)'}\n\n"
        f"{report['config']}\n"
        "Interrupt with Ctrl-C. Lines of JSON here change the hand, the E-stop input and the cable."
    )
