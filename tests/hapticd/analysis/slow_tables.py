"""One table for the tests, simulated once, and a library that holds it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from hapticd.analysis import settling_table
from hapticd.analysis.settling_table import SettlingTable
from hapticd.model import load_model

PHANTOM, HHD = load_model("phantom-1.0"), load_model("hhd")
RATE_HZ = 1000.0


@cache
def phantom_table() -> SettlingTable:
    """The PHANTOM's table at two dampings, none and the largest looked at."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(settling_table, "DAMPING_SHARES", (0.0, 0.8))
        return settling_table.settling_table(PHANTOM, RATE_HZ, 0)


def files(directory: Path) -> list[str]:
    """Names of what is in a directory."""
    return sorted(path.name for path in directory.iterdir())
