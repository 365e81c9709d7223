"""The live table of `hapticd watch`: what the stream said last, drawn for a terminal."""

from __future__ import annotations

from collections import deque

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from hapticd_client.documents import Device, Event
from hapticd_client.status import complaints
from hapticd_client.stream import Data, Happening, Message, Snapshot
from hapticd_client.terminal import millimetres, norm_text, state_text

SIGNALS = ("tip_position_m", "tip_force_n", "contact_depth_m", "lateness_ns", "missed_ticks")
"""What the table shows; watched in batches, so that no peak between two frames is missed."""

HEADINGS = ("device", "state", "tip / mm", "force / N", "peak", "depth / mm", "late / µs", "missed")
WORDS = ("device", "state", "tip / mm")
EVENTS_SHOWN = 6


class Board:
    """The last word on each device, and the last events."""

    def __init__(self) -> None:
        self._devices: dict[str, Device] = {}
        self._data: dict[str, Data] = {}
        self._events: deque[Event] = deque(maxlen=EVENTS_SHOWN)
        self.lost: str | None = None

    @property
    def seen(self) -> bool:
        """Whether there is anything to show."""
        return bool(self._devices)

    def take(self, message: Message) -> None:
        """Notes a message of the stream."""
        match message:
            case Data():
                self._data[message.device_id] = message
            case Snapshot():
                self._devices[message.device["id"]] = message.device
                if not message.device["health"]["online"]:
                    self._data.pop(message.device["id"], None)
            case Happening():
                self._events.append(message.event)

    def __rich__(self) -> RenderableType:
        lines = [line for device in self._devices.values() for line in complaints(device)]
        if self.lost is not None:
            lines.insert(
                0, f"[bold white on red] NOT CONNECTED [/] {escape(self.lost)} [dim]What you see is old.[/]"
            )
        events = [
            Text(_event_line(event), style="dim", no_wrap=True, overflow="ellipsis") for event in self._events
        ]
        return Group(self._table(), *map(Text.from_markup, lines), "", *events)

    def _table(self) -> Table:
        table = Table(box=None, header_style="bold", pad_edge=False, style="dim" if self.lost else "")
        for heading in HEADINGS:
            table.add_column(heading, justify="left" if heading in WORDS else "right", no_wrap=True)
        for device in self._devices.values():
            name = f"[bold]{escape(device['id'])}[/]"
            state = state_text(device["state"], estop=device["flags"]["estop"])
            table.add_row(name, state, *_numbers(device["dof"], self._data.get(device["id"])))
        return table


def _numbers(dof: int, data: Data | None) -> tuple[str, ...]:
    if data is None or not data.count:
        return ("–",) * (len(HEADINGS) - 2)
    forces_n = data.values["tip_force_n"]
    peak_n = max(forces_n, key=_square)
    return (
        millimetres(data.values["tip_position_m"][-1][:dof]),
        norm_text(forces_n[-1]),
        norm_text(peak_n),
        f"{1e3 * (data.values['contact_depth_m'][-1] or 0.0):.2f}",
        f"{max(data.values['lateness_ns']) / 1e3:.0f}",
        str(data.values["missed_ticks"][-1]),
    )


def _square(vector: list[float | None]) -> float:
    return sum((component or 0.0) ** 2 for component in vector)


def _event_line(event: Event) -> str:
    return f"{event['t_utc'][11:19]}  {event['message']}"
