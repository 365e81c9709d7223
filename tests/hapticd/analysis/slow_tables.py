"""One table for the tests, simulated once, and a library that holds it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from hapticd.analysis.settling_table import SettlingTable, settling_table
from hapticd.model import load_model

PHANTOM, HHD = load_model("phantom-1.0"), load_model("hhd")
RATE_HZ = 1000.0


@cache
def phantom_table() -> SettlingTable:
    """The smaller of the two tables: one damping."""
    return settling_table(PHANTOM, RATE_HZ, 0)


def files(directory: Path) -> list[str]:
    """Names of what is in a directory."""
    return sorted(path.name for path in directory.iterdir())
