"""An emulated I/O board in a process of its own, as `hapticd emulate` starts it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any, Self

WATCHDOG_S = 0.25
"""Longer than a shared machine stands still."""


class EmulatedBoard:
    """The HHD's twin behind the real frames, on a pseudo-terminal that ``link`` always names."""

    def __init__(self, link: Path, *, faults: str = "", rate_hz: int = 1000) -> None:
        self.link = link
        self._command = [sys.executable, "-m", "hapticd", "emulate", "hapticd_io", "--twin", "hhd"]
        self._command += ["--rate", str(rate_hz), "--link", str(link), "--json"]
        self._command += ["--faults", faults] if faults else []
        self._process: subprocess.Popen[str] | None = None
        self.report: dict[str, Any] = {}

    def start(self) -> Self:
        """Starts the board; returns once its port is there."""
        self._process = subprocess.Popen(
            self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        assert self._process.stdout is not None
        self.report = json.loads(self._process.stdout.readline())
        return self

    def tell(self, **change: object) -> None:
        """Changes hand, E-stop input or cable."""
        assert self._process is not None
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(change) + "\n")

    def kill(self) -> None:
        """kill -9: the board is gone in the middle of whatever it did."""
        if self._process is not None:
            self._process.kill()
            for stream in (self._process.stdin, self._process.stdout):
                assert stream is not None
                stream.close()
            self._process.wait()
            self._process = None

    def device(self, **keys: object) -> dict[str, Any]:
        """The device that is this board, as a table of the configuration."""
        return {
            "id": "hhd",
            "model": "hhd",
            "driver": "hapticd_io",
            "options": {**self.report["options"], "port": str(self.link), "watchdog_s": WATCHDOG_S},
            **keys,
        }
