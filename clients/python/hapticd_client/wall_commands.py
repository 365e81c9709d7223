"""`hapticd walls`: list, add and remove the walls of a device."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.markup import escape
from rich.table import Table

from hapticd_client.client import Client
from hapticd_client.documents import Wall, WallResult, plane
from hapticd_client.terminal import (
    DeviceArgument,
    DryRunOption,
    JsonOption,
    UrlOption,
    console,
    daemon,
    print_json,
)
from hapticd_client.vector import Vector

app = typer.Typer(no_args_is_help=True, help="List, add and remove the walls of a device.")

WallArgument = Annotated[str, typer.Argument(metavar="WALL", help="Id of the wall, such as floor")]
PointOption = Annotated[
    Vector,
    typer.Option("--point", parser=Vector.parse, metavar="X,Y,Z", help="A point of the wall, m"),
]
NormalOption = Annotated[
    Vector,
    typer.Option("--normal", parser=Vector.parse, metavar="X,Y,Z", help="Unit normal, into free space"),
]
EtaOption = Annotated[float, typer.Option("--eta", help="0 is rigid, 1 is free")]
FadeOption = Annotated[float, typer.Option("--fade", help="Time over which the wall fades in, s")]
ReplaceOption = Annotated[bool, typer.Option("--replace", help="Replace a wall of the same id")]
OptionalDevice = Annotated[str | None, typer.Argument(metavar="[DEVICE]", help="Id of a device; else all")]


@app.command("list")
def list_walls(device: OptionalDevice = None, url: UrlOption = None, as_json: JsonOption = False) -> None:
    """The walls of a device, or of all."""
    with daemon(url, as_json=as_json) as client:
        walls = _walls(client, device)
    if as_json:
        print_json(walls)
    else:
        console.print(_table(walls))


@app.command("add")
def add_wall(
    device: DeviceArgument,
    wall: WallArgument,
    normal: NormalOption,
    point: PointOption,
    eta: EtaOption = 0.0,
    fade_s: FadeOption = 0.2,
    replace: ReplaceOption = False,
    dry_run: DryRunOption = False,
    url: UrlOption = None,
    as_json: JsonOption = False,
) -> None:
    """Add a plane wall; it fades in, also around the tool.

    Example: hapticd walls add phantom floor --point 0,0,-0.02 --normal 0,0,1
    """
    document = plane(wall, point_m=list(point), normal=list(normal), eta=eta, fade_s=fade_s)
    with daemon(url, as_json=as_json) as client:
        result = client.put_wall(device, document, create_only=not replace, dry_run=dry_run)
    _show(result, f"Wall {wall} of {device}", as_json=as_json)


@app.command("remove")
def remove_wall(
    device: DeviceArgument,
    wall: WallArgument,
    dry_run: DryRunOption = False,
    url: UrlOption = None,
    as_json: JsonOption = False,
) -> None:
    """Take a wall away; its force fades out."""
    with daemon(url, as_json=as_json) as client:
        result = client.delete_wall(device, wall, dry_run=dry_run)
    _show(result, f"The scene of {device} without {wall}", as_json=as_json)


def _walls(client: Client, device_id: str | None) -> dict[str, list[Wall]]:
    ids = [device_id] if device_id else [device["id"] for device in client.devices()]
    return {each: client.walls(each) for each in ids}


def _table(walls: dict[str, list[Wall]]) -> Table | str:
    if not any(walls.values()):
        return f"No walls on {', '.join(walls)}. Add one: hapticd walls add --help"
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("device", "wall", "point / m", "normal", "η", "fade / s", ""):
        table.add_column(heading)
    for device_id, scene in walls.items():
        for wall in scene:
            table.add_row(device_id, *_cells(wall))
    return table


def _cells(wall: Wall) -> tuple[str, ...]:
    shape = wall["shape"]
    return (
        escape(wall["id"]),
        ", ".join(f"{coordinate:g}" for coordinate in shape["point_m"]),
        ", ".join(f"{component:g}" for component in shape["normal"]),
        f"{wall['law']['eta']:g}",
        f"{wall.get('fade_s', 0.0):g}",
        "" if wall.get("enabled", True) else "off",
    )


def _show(result: WallResult, subject: str, *, as_json: bool) -> None:
    if as_json:
        print_json(result)
        return
    console.print(f"{escape(subject)} {_outcome(result)}", soft_wrap=True)


def _outcome(result: WallResult) -> str:
    applied, stiffness = result["applied"], result.get("stiffness_n_per_m")
    rendered = f"; {stiffness:.0f} N/m at this pose" if stiffness else ""
    if result["dry_run"]:
        return f"would be accepted{rendered}. Nothing was changed."
    if applied is None:
        return f"is stored, not yet in force: {escape(result['note'] or 'no loop has taken it')}"
    limits = f" (limited by {', '.join(applied['clamped'])})" if applied["clamped"] else ""
    return f"is in force since tick {applied['tick']}, fading over {applied['fade_s']:g} s{rendered}{limits}."
