"""Where a daemon of this user keeps its files, by the XDG base directory specification."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def default_state_dir() -> Path:
    """``$XDG_STATE_HOME/hapticd``, by default ``~/.local/state/hapticd``."""
    return xdg("XDG_STATE_HOME", "~/.local/state") / "hapticd"


def default_runtime_dir() -> Path:
    """``$XDG_RUNTIME_DIR/hapticd``, else a directory of this user under the temporary one."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return Path(runtime) / "hapticd" if runtime else Path(tempfile.gettempdir()) / f"hapticd-{os.getuid()}"


def xdg(variable: str, default: str) -> Path:
    """The directory that ``variable`` names, else ``default``."""
    return Path(os.environ.get(variable) or default).expanduser()
