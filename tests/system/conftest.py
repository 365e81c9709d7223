"""Fixtures that start the whole daemon."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.system.daemon_process import HHD, PHANTOM, DaemonProcess

StartDaemon = Callable[..., DaemonProcess]


@pytest.fixture
def start_daemon(tmp_path: Path) -> Iterator[StartDaemon]:
    """Starts daemons on the devices given, by default one twin of each model; stops them all."""
    started: list[DaemonProcess] = []

    def start(*devices: dict[str, Any]) -> DaemonProcess:
        directory = tmp_path / str(len(started))
        directory.mkdir()
        daemon = DaemonProcess(directory, list(devices) or [PHANTOM, HHD])
        started.append(daemon)
        return daemon.start()

    yield start
    for daemon in started:
        daemon.stop()
