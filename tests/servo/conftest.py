"""Servo processes that end with the test."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.servo.rig import ServoRig


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[ServoRig]:
    made = ServoRig(tmp_path)
    yield made
    made.close()
