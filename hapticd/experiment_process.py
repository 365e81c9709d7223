"""An experiment in a process beside the daemon: started, listened to, ended."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from hapticd.problem import Problem
from hapticd.problem_types import PROBLEM_TYPES

PROGRAM = (sys.executable, "-m", "hapticd.experiments.child")
LOG_FILE = "log.txt"
LOG_TAIL_CHARS = 400
TERMINATE_S = 2.0
"""How long the process may take to go once it is told to."""


async def run_process(
    request: Mapping[str, Any], directory: Path, tell: Callable[[float, str], None]
) -> list[str]:
    """Runs the experiment that ``request`` describes; the names of the files it wrote.

    Cancelled, it ends the process first. ``Problem``: the experiment's own, or experiment-failed.
    """
    with (directory / LOG_FILE).open("wb") as log:
        # A session of its own: Ctrl-C at the daemon's terminal goes to the daemon alone.
        process = await asyncio.create_subprocess_exec(
            *PROGRAM,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=log,
            start_new_session=True,
        )
    try:
        return await _listen(process, request, directory, tell)
    finally:
        await _end(process)


async def _listen(
    process: asyncio.subprocess.Process,
    request: Mapping[str, Any],
    directory: Path,
    tell: Callable[[float, str], None],
) -> list[str]:
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(request).encode() + b"\n")
    async for line in process.stdout:
        told = json.loads(line)
        if "problem" in told:
            raise _problem(told["problem"])
        if "files" in told:
            files: list[str] = told["files"]
            return files
        tell(told["progress"], told["doing"])
    code = await process.wait()
    how = f"was killed by signal {-code}" if code < 0 else f"exited with code {code}"
    raise Problem("experiment-failed", f"The experiment's process {how}. {_last_words(directory)}".rstrip())


async def _end(process: asyncio.subprocess.Process) -> None:
    """Ends the process if it still runs, and reaps it."""
    if process.stdin is not None:
        process.stdin.close()
    with suppress(ProcessLookupError):
        process.terminate()
    try:
        await asyncio.wait_for(process.wait(), TERMINATE_S)
    except TimeoutError:
        process.kill()
        await process.wait()


def _problem(document: Mapping[str, Any]) -> Problem:
    slug = str(document["type"]).rpartition("/")[2]
    return Problem(
        slug if slug in PROBLEM_TYPES else "experiment-failed",
        document["detail"],
        hint=document["hint"],
        pointer=document.get("pointer"),
        allowed=document.get("allowed"),
    )


def _last_words(directory: Path) -> str:
    """The last line of its log; empty when there is none."""
    lines = (directory / LOG_FILE).read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"Its log ends: {lines[-1][-LOG_TAIL_CHARS:]}" if lines else ""
