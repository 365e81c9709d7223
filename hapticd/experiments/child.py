"""One experiment in a process of its own, beside a daemon whose loops it must not disturb.

It reads one JSON object from standard input (experiment, set, seed, jitter, out, state_dir) and writes JSON
objects to standard output, one a line: ``{"progress", "doing"}`` while it runs, and at the end ``{"files"}``
or ``{"problem"}``. It ends when its standard input does: with the daemon.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

from hapticd.experiments.carry_out import Order, carry_out
from hapticd.experiments.catalogue import load
from hapticd.experiments.progress import Progress
from hapticd.experiments.settings import resolve
from hapticd.problem import Problem

NICE = 10
"""Below everything that has to be in time."""

TELL_EVERY_S = 0.1


class Teller:
    """Writes what the daemon is told."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._told_s = 0.0

    def progress(self, fraction: float, doing: str) -> None:
        """Tells how far the run is, not more often than every ``TELL_EVERY_S``."""
        now_s = time.monotonic()
        if now_s - self._told_s >= TELL_EVERY_S:
            self._told_s = now_s
            self.tell({"progress": fraction, "doing": doing})

    def tell(self, line: Mapping[str, Any]) -> None:
        """Writes one line."""
        self._stream.write(json.dumps(line) + "\n")
        self._stream.flush()


def main() -> None:
    """Carries out the one request on standard input."""
    os.nice(NICE)
    # Whatever an experiment prints must not get between the lines of the protocol.
    teller = Teller(os.fdopen(os.dup(1), "w", encoding="utf-8"))
    os.dup2(2, 1)
    request = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_input, daemon=True).start()
    try:
        finished = carry_out(_order(request), Progress(teller.progress))
    except Problem as problem:
        teller.tell({"problem": problem.document()})
    else:
        teller.tell({"files": [file.name for file in finished.files]})


def _order(request: Mapping[str, Any]) -> Order:
    experiment = load(request["experiment"])
    return Order(
        experiment,
        resolve(experiment, request["set"]),
        request["seed"],
        request["jitter"],
        Path(request["out"]),
        Path(request["state_dir"]),
    )


def _end_with_input() -> None:
    """Ends the process once its standard input ends: nobody waits for the result any more."""
    sys.stdin.read()
    os._exit(1)


if __name__ == "__main__":
    main()
