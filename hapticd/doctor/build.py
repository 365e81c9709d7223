"""What is installed: Python, hapticd, and its Rust core."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from importlib import metadata

from hapticd.doctor.finding import Finding, fail, ok


def examine() -> Iterator[Finding]:
    """Versions, and whether the Rust core can be loaded."""
    yield ok("python", f"Python {platform.python_version()} on {platform.platform(terse=True)}.")
    yield _core()


def _core() -> Finding:
    try:
        from hapticd import _core
    except ImportError as error:
        return fail("core", f"The Rust core cannot be loaded: {error}.", "make .venv/.installed")
    version = metadata.version("hapticd")
    facts = ", ".join(f"{name} {value}" for name, value in _core.build_info().items())
    return ok("core", f"hapticd {version} ({facts}).")
