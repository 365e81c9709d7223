"""The process that runs an experiment beside the daemon."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import pytest

from hapticd.experiments.child import NICE
from tests.hapticd.experiments.fake_experiment import IMPORT_STRING


@pytest.fixture
def child(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """A child that runs until somebody ends it."""
    request = {
        "experiment": IMPORT_STRING,
        "set": {"how": "long"},
        "seed": 1,
        "jitter": 0,
        "out": str(tmp_path / "out"),
        "state_dir": str(tmp_path / "state"),
    }
    command = [sys.executable, "-m", "hapticd.experiments.child"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        pipe(process.stdin).write(json.dumps(request) + "\n")
        pipe(process.stdin).flush()
        yield process
        process.kill()


def pipe(stream: IO[str] | None) -> IO[str]:
    assert stream is not None
    return stream


def test_it_tells_its_progress_stands_back_and_ends_with_the_daemon(child: subprocess.Popen[str]) -> None:
    told = json.loads(pipe(child.stdout).readline())
    assert told == {"progress": 0.5, "doing": "waiting"}
    assert os.getpriority(os.PRIO_PROCESS, child.pid) == NICE
    pipe(child.stdin).close()
    assert child.wait(30) == 1
