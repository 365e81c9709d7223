"""The commands that this client adds to `hapticd`; the entry point group `hapticd.commands` names `app`."""

from __future__ import annotations

import typer

from hapticd_client import state_commands, wall_commands
from hapticd_client.status import overview
from hapticd_client.terminal import JsonOption, UrlOption, console, daemon, print_json
from hapticd_client.watch import watch

LOOKING = "Looking"
CHANGING = "Changing"

app = typer.Typer()


@app.command(rich_help_panel=LOOKING)
def status(url: UrlOption = None, as_json: JsonOption = False) -> None:
    """Every device at a glance, and what to do where something is wrong."""
    with daemon(url, as_json=as_json) as client:
        devices = client.devices()
    if as_json:
        print_json(devices)
    else:
        console.print(overview(devices))


app.command(rich_help_panel=LOOKING)(watch)
app.add_typer(wall_commands.app, name="walls", rich_help_panel=CHANGING)
app.command(rich_help_panel=CHANGING)(state_commands.enable)
app.command(rich_help_panel=CHANGING)(state_commands.disable)
app.command(rich_help_panel=CHANGING)(state_commands.pause)
app.command(rich_help_panel=CHANGING)(state_commands.estop)
app.command(rich_help_panel=CHANGING)(state_commands.acknowledge)
