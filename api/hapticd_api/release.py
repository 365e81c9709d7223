"""Which hapticd this is."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version


@cache
def release() -> str:
    """The version of the distribution; `0+source` for a checkout that runs without being installed."""
    try:
        return version("hapticd")
    except PackageNotFoundError:
        return "0+source"
