"""`hapticd walls`: list, add and remove the walls of a device."""

from __future__ import annotations

from typing import Annotated, cast

import typer
from rich.markup import escape
from rich.table import Table

from hapticd_client.client import Client
from hapticd_client.documents import WallResult
from hapticd_client.spec import Spec
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
from hapticd_client.wall_text import friction_in_words, granted_in_words, law_in_words, shape_in_words
from hapticd_client.walls import Friction, Law, Shape, Wall, motion
from hapticd_client.walls import wall as wall_of

app = typer.Typer(no_args_is_help=True, help="List, add and remove the walls of a device.")

WallArgument = Annotated[str, typer.Argument(metavar="WALL", help="Id of the wall, such as floor")]
PointOption = Annotated[
    Vector | None,
    typer.Option("--point", parser=Vector.parse, metavar="X,Y,Z", help="A point of a plane, m"),
]
NormalOption = Annotated[
    Vector | None,
    typer.Option("--normal", parser=Vector.parse, metavar="X,Y,Z", help="Its unit normal, into free space"),
]
ShapeOption = Annotated[
    Spec | None,
    typer.Option(
        "--shape",
        parser=Spec.parse,
        metavar="SPEC",
        help="Or any: 'sphere center_m=0.2,0,0 radius_m=0.02'",
    ),
]
LawOption = Annotated[
    Spec | None,
    typer.Option("--law", parser=Spec.parse, metavar="SPEC", help="Any law: 'spring stiffness_n_per_m=800'"),
]
FrictionOption = Annotated[
    Spec | None,
    typer.Option("--friction", parser=Spec.parse_fields, metavar="SPEC", help="'static=0.4 kinetic=0.3'"),
]
EtaOption = Annotated[float, typer.Option("--eta", help="Law without --law: 0 is rigid, 1 is free")]
ForceOption = Annotated[
    bool, typer.Option("--force", help="Over the stability budget too; passivity then bounds it")
]
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
    point: PointOption = None,
    normal: NormalOption = None,
    shape: ShapeOption = None,
    law: LawOption = None,
    eta: EtaOption = 0.0,
    friction: FrictionOption = None,
    fade_s: FadeOption = 0.2,
    replace: ReplaceOption = False,
    force: ForceOption = False,
    dry_run: DryRunOption = False,
    url: UrlOption = None,
    as_json: JsonOption = False,
) -> None:
    """Add a wall; it fades in, also around the tool.

    Examples: hapticd walls add phantom floor --point 0,0,-0.02 --normal 0,0,1

    hapticd walls add phantom ball --shape 'sphere center_m=0.2,0,0 radius_m=0.02' --law 'damper
    damping_n_s_per_m=10'
    """
    document = wall_of(wall, _shape(shape, point, normal), law=cast("Law", law or motion(eta)), fade_s=fade_s)
    document["friction"] = cast("Friction | None", friction)
    with daemon(url, as_json=as_json) as client:
        result = client.put_wall(device, document, create_only=not replace, dry_run=dry_run, force=force)
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


def _shape(shape: Spec | None, point: Vector | None, normal: Vector | None) -> Shape:
    """The shape that was spelt, or the plane. Raises ``typer.BadParameter`` where it is not one of both."""
    if (shape is None) == (point is None or normal is None):
        raise typer.BadParameter("Write either --point and --normal, or --shape.")
    if shape is not None:
        return cast("Shape", shape)
    return {"type": "plane", "point_m": list(point or ()), "normal": list(normal or ())}


def _walls(client: Client, device_id: str | None) -> dict[str, list[Wall]]:
    ids = [device_id] if device_id else [device["id"] for device in client.devices()]
    return {each: client.walls(each) for each in ids}


def _table(walls: dict[str, list[Wall]]) -> Table | str:
    if not any(walls.values()):
        return f"No walls on {', '.join(walls)}. Add one: hapticd walls add --help"
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("device", "wall", "shape / m", "law", "friction", "fade / s", ""):
        table.add_column(heading)
    for device_id, scene in walls.items():
        for wall in scene:
            table.add_row(device_id, *_cells(wall))
    return table


def _cells(wall: Wall) -> tuple[str, ...]:
    return (
        escape(wall["id"]),
        shape_in_words(wall),
        law_in_words(wall),
        friction_in_words(wall),
        f"{wall.get('fade_s', 0.0):g}",
        "" if wall.get("enabled", True) else "off",
    )


def _show(result: WallResult, subject: str, *, as_json: bool) -> None:
    if as_json:
        print_json(result)
        return
    console.print(f"{escape(subject)} {_outcome(result)}", soft_wrap=True)


def _outcome(result: WallResult) -> str:
    applied, rendered = result["applied"], escape(granted_in_words(result))
    if result["dry_run"]:
        return f"would be accepted{rendered}. Nothing was changed."
    if applied is None:
        return f"is stored, not yet in force: {escape(result['note'] or 'no loop has taken it')}"
    limits = f" (limited by {', '.join(applied['clamped'])})" if applied["clamped"] else ""
    return f"is in force since tick {applied['tick']}, fading over {applied['fade_s']:g} s{rendered}{limits}."
