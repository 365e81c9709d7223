"""`hapticd watch`: a live table of all devices, or the stream as lines of JSON."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Annotated, Any

import typer
from rich.live import Live

from hapticd_client.board import SIGNALS, Board
from hapticd_client.error import StreamClosed, Unreachable
from hapticd_client.stream import Data, Happening, Message, Snapshot, open_stream
from hapticd_client.terminal import JsonOption, UrlOption, console, reported

FRAMES_HZ = 10.0
"""Frames a second: more than a person can read digits, few enough for a slow terminal."""

RETRY_S = 1.0

OptionalDevices = Annotated[list[str] | None, typer.Argument(metavar="[DEVICE...]", help="Else all")]


def watch(devices: OptionalDevices = None, url: UrlOption = None, as_json: JsonOption = False) -> None:
    """Watch devices live: state, tip, force, depth, late ticks, events. Ctrl-C ends it."""
    with reported(as_json=as_json):
        try:
            if as_json:
                _follow(url, devices, _print_line)
            else:
                _follow_on_board(url, devices)
        except KeyboardInterrupt:
            return


def _follow_on_board(url: str | None, devices: Sequence[str] | None) -> None:
    board = Board()
    with Live(board, console=console, refresh_per_second=FRAMES_HZ):
        while True:
            try:
                _follow(url, devices, lambda message: _show(board, message))
            except (StreamClosed, Unreachable) as error:
                if not board.seen or (isinstance(error, StreamClosed) and error.final):
                    raise
                board.lost = str(error)
            time.sleep(RETRY_S)


def _follow(url: str | None, devices: Sequence[str] | None, take: Callable[[Message], None]) -> None:
    with open_stream(url) as stream:
        for device_id in devices or stream.device_ids:
            stream.subscribe(device_id, SIGNALS, rate_hz=FRAMES_HZ, mode="batch")
        for message in stream:
            take(message)


def _show(board: Board, message: Message) -> None:
    board.lost = None
    board.take(message)


def _print_line(message: Message) -> None:
    print(json.dumps(_document(message), ensure_ascii=False), flush=True)


def _document(message: Message) -> dict[str, Any]:
    match message:
        case Data():
            return {"type": "data", **asdict(message)}
        case Snapshot():
            return {"type": "snapshot", "device": message.device}
        case Happening():
            return {"type": "event", "event": message.event}
