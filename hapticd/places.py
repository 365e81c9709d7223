"""Where a daemon of this user keeps its files, by the XDG base directory specification."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

MEMORY = Path("/dev/shm")
"""A file system in memory, on every Linux."""


def default_state_dir() -> Path:
    """``$XDG_STATE_HOME/hapticd``, by default ``~/.local/state/hapticd``."""
    return xdg("XDG_STATE_HOME", "~/.local/state") / "hapticd"


def default_runtime_dir() -> Path:
    """``$XDG_RUNTIME_DIR/hapticd``, else one of this user in memory, else one under the temporary one.

    In memory, because writing shared pages back to a disk can hold up the loop that touches them.
    """
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime:
        return Path(runtime) / "hapticd"
    parent = MEMORY if os.access(MEMORY, os.W_OK) else Path(tempfile.gettempdir())
    return parent / f"hapticd-{os.getuid()}"


def xdg(variable: str, default: str) -> Path:
    """The directory that ``variable`` names, else ``default``."""
    return Path(os.environ.get(variable) or default).expanduser()
