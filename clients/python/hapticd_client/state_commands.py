"""Commands that change the state of devices: enable, disable, pause, estop, acknowledge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, TypeVar

import typer
from rich.markup import escape

from hapticd_client.client import Client
from hapticd_client.documents import Desired, EstopReport, StateReport
from hapticd_client.error import Refused
from hapticd_client.terminal import (
    DeviceArgument,
    JsonOption,
    UrlOption,
    console,
    daemon,
    print_json,
    state_text,
)

Report = TypeVar("Report")

DevicesArgument = Annotated[list[str], typer.Argument(metavar="DEVICE...", help="Ids of devices")]
OptionalDevices = Annotated[list[str] | None, typer.Argument(metavar="[DEVICE...]", help="Else all")]
AcknowledgeOption = Annotated[bool, typer.Option("--acknowledge", help="Clear the latch instead")]
FaultsArgument = Annotated[list[str] | None, typer.Argument(metavar="[FAULT...]", help="Else all latched")]


def enable(devices: DevicesArgument, url: UrlOption = None, as_json: JsonOption = False) -> None:
    """Let devices render forces; they ramp up."""
    _set_state(devices, "enabled", url, as_json)


def disable(devices: DevicesArgument, url: UrlOption = None, as_json: JsonOption = False) -> None:
    """Fade forces out and leave devices without any."""
    _set_state(devices, "disabled", url, as_json)


def pause(devices: DevicesArgument, url: UrlOption = None, as_json: JsonOption = False) -> None:
    """Fade forces out for a while; 'enable' brings them back."""
    _set_state(devices, "paused", url, as_json)


def estop(
    devices: OptionalDevices = None,
    acknowledge: AcknowledgeOption = False,
    url: UrlOption = None,
    as_json: JsonOption = False,
) -> None:
    """Stop devices now and latch it; all devices, unless some are named."""
    with daemon(url, as_json=as_json) as client:
        reports = _acknowledge_estops(client, devices) if acknowledge else _engage_estops(client, devices)
    if as_json:
        print_json(reports)
        return
    for report in reports:
        text = state_text(report["state"], estop=report["engaged"])
        console.print(f"{escape(report['device_id'])}: {text}")


def acknowledge(
    device: DeviceArgument,
    faults: FaultsArgument = None,
    url: UrlOption = None,
    as_json: JsonOption = False,
) -> None:
    """Clear latched faults whose cause is gone; the device stays disabled."""
    with daemon(url, as_json=as_json) as client:
        latched = faults or [fault["id"] for fault in client.faults(device)]
        for fault in latched:
            client.acknowledge_fault(device, fault)
    if as_json:
        print_json({"device_id": device, "acknowledged": latched})
    else:
        console.print(
            f"{escape(device)}: acknowledged {', '.join(map(escape, latched)) or 'nothing, none latched'}"
        )


def _set_state(devices: list[str], desired: Desired, url: str | None, as_json: bool) -> None:
    reports: list[StateReport] = []
    with daemon(url, as_json=as_json) as client:

        def ask(device_id: str) -> StateReport:
            reports.append(report := client.set_state(device_id, desired))
            if not as_json:
                _show(report)
            return report

        _each(ask, devices)
    if as_json:
        print_json(reports)


def _show(report: StateReport) -> None:
    applied = report["applied"]
    since = f" since tick {applied['tick']}" if applied else ""
    text = state_text(report["state"], estop=report["flags"]["estop"])
    console.print(f"{escape(report['device_id'])} is {text}{since}")


def _engage_estops(client: Client, devices: list[str] | None) -> list[EstopReport]:
    return _each(client.engage_estop, devices) if devices else client.engage_all_estops()


def _acknowledge_estops(client: Client, devices: list[str] | None) -> list[EstopReport]:
    return _each(client.acknowledge_estop, devices) if devices else client.acknowledge_all_estops()


def _each(act: Callable[[str], Report], devices: list[str]) -> list[Report]:
    """Acts on every device, and only then complains of those that refused: one must not shield the next."""
    reports, refusals = [], []
    for device_id in devices:
        try:
            reports.append(act(device_id))
        except Refused as refused:
            refusals.append(refused)
    if refusals:
        raise refusals[0]
    return reports
