"""A twin in the place of a daemon's device, lent to an experiment."""

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from hapticd.twin import TwinRun


class TwinBench:
    """Enabled; its hand is free until it is told something."""

    device_id = "bench"
    dof = 3

    def __init__(self, twin: TwinRun, *, is_twin: bool = True) -> None:
        self.twin = twin
        self.model = twin.model.name
        self.rate_hz = twin.rate_hz
        self.is_twin = is_twin
        self.scenes: list[Mapping[str, Any]] = []
        twin.enable()
        twin.run(0.5)

    async def scene(self, scene: Mapping[str, Any]) -> None:
        self.scenes.append(scene)
        self.twin.scene(scene)

    async def record(self, duration_s: float) -> NDArray[Any]:
        return self.twin.run(duration_s)

    async def hand(self, script: Mapping[str, Any]) -> None:
        self.twin.hand(script)
