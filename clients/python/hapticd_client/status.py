"""`hapticd status`: every device at a glance, and what to do where something is wrong."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from hapticd_client.documents import Device
from hapticd_client.terminal import millimetres, norm_text, state_text

FAULT_LATCHED = "fault-latched"
"""The interlock that says there are faults, which are listed themselves."""

HEADINGS = ("device", "state", "driver", "tip / mm", "force / N", "walls", "touches")


def overview(devices: list[Device]) -> RenderableType:
    """A table of all devices, and below it what keeps them from rendering."""
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in HEADINGS:
        table.add_column(heading, no_wrap=True)
    for device in devices:
        table.add_row(*_cells(device))
    return Group(table, *[Text.from_markup(line) for device in devices for line in complaints(device)])


def _cells(device: Device) -> tuple[str, ...]:
    return (
        f"[bold]{escape(device['id'])}[/]",
        state_text(device["state"], estop=device["flags"]["estop"]),
        escape(device["driver"]),
        millimetres(device["tip_position_m"]),
        norm_text(device["tip_force_n"]),
        str(device["walls"]),
        escape(device["contact_wall"] or "–"),
    )


def complaints(device: Device) -> list[str]:
    """What is wrong with a device, each with its cure, as lines of markup."""
    name = escape(device["id"])
    lines = [
        f"[bold red]{name}: {escape(fault['id'])}[/] {escape(fault['cause'])} {escape(fault['cure'])}"
        for fault in device["faults"]
    ]
    if not device["health"]["online"]:
        why = device["health"].get("why") or "Its servo does not run."
        lines.append(f"[bold red]{name}: offline[/] {escape(why)}")
        return lines
    return lines + [
        f"[yellow]{name}: {escape(interlock['id'])}[/] {escape(interlock['why'])} {escape(interlock['cure'])}"
        for interlock in device["interlocks"]
        if not interlock["ok"] and interlock["id"] != FAULT_LATCHED
    ]
