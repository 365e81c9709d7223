"""A device of a running daemon, lent to an experiment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from numpy.typing import NDArray

from hapticd.experiments.experiment import Experiment, Outcome

if TYPE_CHECKING:
    from hapticd.experiments.run import Run


class DeviceBench(Protocol):
    """One enabled device that renders what the experiment says, and nothing else.

    While it is lent, edits of its scene are refused; disabling and the E-stop are not. When the experiment
    ends, however it ends, the scene from before is put back. Every coroutine raises ``Problem``, also once
    the device is no longer enabled.
    """

    @property
    def device_id(self) -> str:
        """Id in the configuration."""
        ...

    @property
    def model(self) -> str:
        """Name of the device model, for example ``phantom-1.0``."""
        ...

    @property
    def rate_hz(self) -> float:
        """Ticks a second."""
        ...

    @property
    def dof(self) -> int:
        """Coordinates of the device: 2 or 3."""
        ...

    @property
    def is_twin(self) -> bool:
        """Whether a simulated hand can be told what to do."""
        ...

    async def scene(self, scene: Mapping[str, Any]) -> None:
        """Renders a scene, flat as ``TwinRun.scene`` takes it; in force when this returns."""
        ...

    async def record(self, duration_s: float) -> NDArray[Any]:
        """The next ticks without a gap: a structured array of ``record_dtype()``, shape (ticks,)."""
        ...

    async def hand(self, script: Mapping[str, Any]) -> None:
        """Tells a twin's hand what to do, as ``TwinRun.hand`` takes it. ``Problem`` (not-a-twin)."""
        ...


@runtime_checkable
class DeviceExperiment(Experiment, Protocol):
    """An experiment that also runs on a device of a daemon, of one of ``device_models``."""

    device_models: tuple[str, ...]

    async def run_on(self, run: Run, bench: DeviceBench) -> Outcome:
        """Carries it out on the device. ``run`` has parameters, seed, random numbers and progress."""
        ...
