"""The daemon's directories: writable, with room, and shared memory on a file system in memory."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

from hapticd.config import Config
from hapticd.doctor.finding import Finding, fail, ok, warn

FREE_MIN_BYTES = 200_000_000
"""Room below which a warning is due: shared memory takes some 10 MB per device, events and scenes little."""

MOUNTS = Path("/proc/self/mounts")


def examine(config: Config) -> Iterator[Finding]:
    """State and runtime directory."""
    yield _directory("state directory", config.paths.state_dir)
    yield _directory("runtime directory", config.paths.runtime_dir)
    yield _memory_backed("runtime directory", config.paths.runtime_dir)


def _directory(subject: str, directory: Path) -> Finding:
    present = _nearest_present(directory)
    if not present.is_dir():
        return fail(
            subject, f"{present} is not a directory.", f"Remove it, or name another {subject} under [paths]."
        )
    if not os.access(present, os.W_OK | os.X_OK):
        return fail(subject, f"{present} is not writable.", f"sudo install -d -o $USER {directory}")
    free_bytes = shutil.disk_usage(present).free
    if free_bytes < FREE_MIN_BYTES:
        return warn(
            subject, f"{directory} has {free_bytes / 1e6:.0f} MB left.", "Make room on its file system."
        )
    return ok(subject, f"{directory} {'is writable' if present == directory else 'can be made'}.")


def _nearest_present(directory: Path) -> Path:
    return next(place for place in (directory, *directory.parents) if place.exists())


def _memory_backed(subject: str, directory: Path) -> Finding:
    kind = file_system_of(directory, MOUNTS.read_text(encoding="utf-8"))
    if kind in ("tmpfs", "ramfs", "devtmpfs"):
        return ok(subject, f"It lies in memory ({kind}).")
    cure = "Set runtime_dir under [paths] to a directory on a tmpfs, such as /dev/shm/hapticd."
    return warn(subject, f"It lies on {kind}: writing pages back to disk can delay a tick.", cure)


def file_system_of(path: Path, mounts: str) -> str:
    """The file system type that ``path`` lies on, by the text of /proc/self/mounts; the last mount wins."""
    best, kind = -1, "an unknown file system"
    for line in mounts.splitlines():
        point, name = line.split(" ")[1:3]
        mounted = Path(point.replace("\\040", " "))
        depth = len(mounted.parts)
        if depth >= best and path.is_relative_to(mounted):
            best, kind = depth, name
    return kind
