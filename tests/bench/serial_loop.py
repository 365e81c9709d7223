"""The HHD's loop closed over real frames on a pseudo-terminal: exchange and lateness."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from tests.bench.durations import HEADER, between
from tests.system.daemon_process import DaemonProcess
from tests.system.emulated_board import EmulatedBoard


def measure(seconds: int) -> str:
    """The page's section."""
    with tempfile.TemporaryDirectory() as directory:
        board = EmulatedBoard(Path(directory) / "board").start()
        daemon = DaemonProcess(Path(directory), [board.device()])
        try:
            return _measured(daemon.start(), seconds)
        finally:
            daemon.stop()
            board.kill()


def _measured(daemon: DaemonProcess, seconds: int) -> str:
    daemon.put("hhd/state", {"desired": "enabled"})
    before = daemon.http.get("/api/v1/system/realtime").json()["devices"]["hhd"]
    time.sleep(seconds)
    after = daemon.http.get("/api/v1/system/realtime").json()["devices"]["hhd"]
    missed = after["missed_ticks"] - before["missed_ticks"]
    rows = [
        between(before["lateness"], after["lateness"]).row(
            "lateness", f"{missed} missed of {after['tick'] - before['tick']}"
        ),
        between(before["exchange"], after["exchange"]).row("exchange, frames both ways"),
    ]
    return "\n".join([f"HHD over a pseudo-terminal at 1000 Hz for {seconds} s, host-paced", HEADER, *rows])
