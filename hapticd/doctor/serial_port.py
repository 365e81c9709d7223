"""Serial ports that the configuration names: whether they are there and may be opened."""

from __future__ import annotations

import grp
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from hapticd.config import Config
from hapticd.doctor.finding import Finding, fail, ok

LIST_PORTS = "ls -l /dev/serial/by-id names those there are."

OPTION = "port"
"""The drivers' option that holds a path or, with a scheme, a pyserial URL."""


def examine(config: Config) -> Iterator[Finding]:
    """Each device whose driver is given a port by path."""
    for device in config.devices:
        port = device.options.get(OPTION)
        if isinstance(port, str) and port.startswith("/"):
            yield _port(f"port of {device.id}", Path(port))


def _port(subject: str, port: Path) -> Finding:
    if not port.exists():
        return fail(subject, f"{port} does not exist.", f"Check cable and power; {LIST_PORTS}")
    if not stat.S_ISCHR(port.stat().st_mode):
        return fail(subject, f"{port} is not a serial port.", f"Correct the port; {LIST_PORTS}")
    if not os.access(port, os.R_OK | os.W_OK):
        return fail(subject, f"You may not open {port}.", _permission_cure(port))
    return ok(subject, f"{port} can be opened.")


def _permission_cure(port: Path) -> str:
    gid = port.stat().st_gid
    try:
        group = grp.getgrgid(gid).gr_name
    except KeyError:
        group = str(gid)
    return f"sudo usermod -aG {group} $USER, then log in again"
