"""A configuration that touches nothing of this machine."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hapticd.config import Config, DeviceConfig

MakeConfig = Callable[..., Config]


@pytest.fixture
def make_config(tmp_path: Path) -> MakeConfig:
    """A configuration with one device, whose members are given."""

    def make(**device: Any) -> Config:
        only = DeviceConfig(**{"id": "phantom", "model": "phantom-1.0", **device})
        paths = {"state_dir": tmp_path / "state", "runtime_dir": tmp_path / "run"}
        return Config(devices=(only,), paths=paths)

    return make
