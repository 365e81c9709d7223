"""What a run of an experiment is set to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hapticd.experiments.experiment import Value


@dataclass(frozen=True)
class Settings:
    """Every parameter resolved. ``overrides`` are what the user set in each device model, by dotted key."""

    parameters: Mapping[str, Value]
    overrides: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
