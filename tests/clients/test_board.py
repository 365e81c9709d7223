"""The live table: peaks between frames are shown, old numbers are not taken for new ones."""

from __future__ import annotations

from typing import Any

import pytest
from rich.console import Console

from hapticd_client.board import Board
from hapticd_client.stream import Data, Happening, Snapshot
from tests.clients.daemon_double import device


def drawn(board: Board) -> list[str]:
    console = Console(width=110, no_color=True)
    with console.capture() as capture:
        console.print(board)
    return capture.get().splitlines()


def data(**values: Any) -> Data:
    columns = {
        "tip_position_m": [[0.1, 0.0, 0.0], [0.2, 0.0, -0.021]],
        "tip_force_n": [[0.0, 0.0, 7.0], [0.0, 3.0, 4.0]],
        "contact_depth_m": [0.0, 0.0015],
        "lateness_ns": [90_000, 12_000],
        "missed_ticks": [3, 4],
        **values,
    }
    return Data("phantom", tick=5, t_mono_ns=1, count=2, dropped=0, values=columns)


@pytest.fixture
def board() -> Board:
    board = Board()
    board.take(Snapshot(device(state="enabled")))
    return board


def test_a_frame_shows_its_newest_tick_and_its_worst(board: Board) -> None:
    board.take(data())
    cells = drawn(board)[1].split()
    assert cells == ["phantom", "enabled", "200.0", "0.0", "-21.0", "5.00", "7.00", "1.50", "90", "4"]


def test_a_planar_device_shows_two_coordinates(board: Board) -> None:
    board.take(Snapshot(device(dof=2)))
    board.take(data())
    assert drawn(board)[1].split()[2:5] == ["200.0", "0.0", "5.00"]


def test_a_value_that_is_not_a_number_does_not_end_the_table(board: Board) -> None:
    board.take(data(tip_force_n=[[None, None, None], [0.0, 3.0, 4.0]], contact_depth_m=[None, None]))
    assert "5.00" in drawn(board)[1]


def test_numbers_of_a_device_that_went_offline_disappear(board: Board) -> None:
    board.take(data())
    offline = {"online": False, "why": "The servo died.", "restarts": 1, "missed_ticks": 0}
    board.take(Snapshot(device(state="offline", health=offline)))
    text = "\n".join(drawn(board))
    assert "200.0" not in text
    assert "The servo died." in text


def test_a_lost_connection_is_unmistakable(board: Board) -> None:
    board.lost = "The stream was closed."
    assert any("NOT CONNECTED" in line and "The stream was closed." in line for line in drawn(board))


def test_events_are_shown_newest_last_and_only_a_few(board: Board) -> None:
    for number in range(20):
        event: Any = {"id": number, "t_utc": "2026-01-01T12:34:56Z", "message": f"Event {number}."}
        board.take(Happening(event))
    lines = drawn(board)
    assert lines[-1] == "12:34:56  Event 19."
    assert not any("Event 13." in line for line in lines)
