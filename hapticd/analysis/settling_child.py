"""A settling table from a process of its own, so that seconds of work neither hold the interpreter's lock
nor take the processor from a loop."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from hapticd.analysis.settling_table import Abandoned, SettlingTable, settling_table
from hapticd.model import Model

NICE = 19
"""nice(2) of the process. A thread of this urgency would keep the lock from its whole process."""

ASK_S = 0.2
"""How often is asked whether the table is still wanted."""


def settling_table_apart(
    model: Model, rate_hz: float, ticks: int, wanted: Callable[[], bool] = lambda: True
) -> SettlingTable:
    """``settling_table`` in another process. ``ValueError`` and ``Abandoned`` as there."""
    order = json.dumps({"model": asdict(model), "rate_hz": rate_hz, "ticks": ticks}) + "\n"
    command = [sys.executable, "-m", __name__]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        try:
            answer = _answer(child, order, wanted)
        finally:
            child.kill()
    document: dict[str, Any] = json.loads(answer or '{"error": "The process that simulates it was ended."}')
    if "error" in document:
        raise ValueError(document["error"])
    return SettlingTable(
        tuple(document["damping_n_s_per_m"]), tuple(document["stiffness_n_per_m"]), document["bound_m"]
    )


def _answer(child: subprocess.Popen[str], order: str, wanted: Callable[[], bool]) -> str:
    assert child.stdin is not None
    assert child.stdout is not None
    child.stdin.write(order)
    child.stdin.flush()  # stays open: its end tells the child that nobody waits any more
    answers: list[str] = []
    reader = threading.Thread(target=lambda out: answers.append(out.readline()), args=(child.stdout,))
    reader.start()
    while reader.is_alive():
        reader.join(ASK_S)
        if not wanted():
            child.kill()
            reader.join()
            raise Abandoned
    return answers[0]


def main() -> None:
    """Simulates the one table ordered on standard input."""
    os.nice(NICE)
    order = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_input, daemon=True).start()
    try:
        answer = asdict(settling_table(Model(**order["model"]), order["rate_hz"], order["ticks"]))
    except ValueError as error:
        answer = {"error": str(error)}
    print(json.dumps(answer), flush=True)


def _end_with_input() -> None:
    sys.stdin.read()
    os._exit(0)


if __name__ == "__main__":
    main()
