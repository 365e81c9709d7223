"""The stability of one device of the station: its budgets, at its rate and its measured delay."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence

from hapticd.analysis.advice import advise
from hapticd.analysis.device_loop import DeviceLoop, device_loop
from hapticd.analysis.settling import bound_m, push
from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.analysis.settling_table import delay_ticks, delayed, drive_values, wall_law
from hapticd.analysis.stability import Simulated, StabilityBudget, stability_budget
from hapticd.analysis.wall_law import WallLaw, slopes_of
from hapticd.laws import Law
from hapticd.model import Model


class DeviceStability:
    """Budgets for the walls of one device.

    ``delay_s`` tells the delay from the encoders' latch to the actuators, measured where it can be.
    """

    def __init__(
        self, model: Model, rate_hz: float, delay_s: Callable[[], float], library: SettlingLibrary
    ) -> None:
        self._model = model
        self._rate_hz = rate_hz
        self._delay_s = delay_s
        self._library = library

    def prepare(self) -> None:
        """Begins to simulate what budgets will need, in the background, and finds the worst pose now."""
        self.loop()
        if self._has_twin:
            self._library.prepare(self._model, self._rate_hz, delay_ticks(self._rate_hz, self._delay_s()))

    def loop(
        self,
        rate_hz: float | None = None,
        delay_s: float | None = None,
        q: Sequence[float] | None = None,
    ) -> DeviceLoop:
        """The device's loop at the configured rate and the measured delay, or at others.

        ``q``, (3,) rad, is the pose; see ``device_loop``.
        """
        rate_hz = self._rate_hz if rate_hz is None else rate_hz
        if delay_s is None:
            delay_s = 1.0 / rate_hz + self._delay_s() - 1.0 / self._rate_hz
        return device_loop(self._model, rate_hz, delay_s, q)

    def slopes(self, law: Law, loop: DeviceLoop) -> WallLaw:
        """The slopes of a law on this device."""
        return slopes_of(law, loop.coupling, loop.force_max_n)

    def budget(self, law: Law, loop: DeviceLoop | None = None, *, advice: bool = False) -> StabilityBudget:
        """The budget of a wall with this law.

        A few milliseconds. Where the twin's table is missing it is begun in the background, and the linear
        limit decides; where that would refuse the wall, one push on the twin may still allow it (30 ms).
        """
        loop = loop or self.loop()
        slopes = self.slopes(law, loop)
        ticks = delay_ticks(loop.rate_hz, loop.delay_s)
        table = self._library.find(self._model, loop.rate_hz, ticks) if self._has_twin else None
        budget = stability_budget(loop, slopes, Simulated(table))
        if table is None and self._has_twin and slopes.stiffness_n_per_m > 0.0:
            self._library.prepare(self._model, loop.rate_hz, ticks)
            if budget.verdict == "unstable" and self._settles(loop, budget, ticks):
                budget = stability_budget(loop, slopes, Simulated(None, requested_settles=True))
        if advice or budget.verdict == "unstable":
            budget = budget.model_copy(update={"advice": tuple(advise(loop, slopes))})
        return budget

    def _settles(self, loop: DeviceLoop, budget: StabilityBudget, ticks: int) -> bool:
        stiffness, damping = budget.granted_n_per_m or 0.0, budget.requested_n_s_per_m or 0.0
        values = drive_values(self._model, loop, stiffness, damping)
        model = delayed(self._model, loop.rate_hz, ticks).changed(values)
        return push(model, loop.rate_hz, law=wall_law(loop, damping)).settled(bound_m(loop))

    @property
    def _has_twin(self) -> bool:
        return json.loads(self._model.twin_json) is not None
