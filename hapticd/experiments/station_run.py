"""An experiment on a device of the daemon: in a thread of its own, so that the daemon goes on."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine, Mapping
from contextlib import suppress
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from hapticd.device import Device
from hapticd.experiments.bench import DeviceExperiment
from hapticd.experiments.carry_out import Finished, Order, check_libraries, finish
from hapticd.experiments.progress import Cancelled, Progress
from hapticd.experiments.run import Run
from hapticd.loan import Loan
from hapticd.problem import Problem
from hapticd.record import record_dtype

Result = TypeVar("Result")

POLL_S = 0.02
READ_MAX_TICKS = 4096
CANCEL_S = 2.0
LATE_S = 1.0
"""How much longer than announced a recording may take before the device counts as lost."""


class LentBench:
    """A device lent to an experiment in another thread; see ``DeviceBench``."""

    def __init__(self, device: Device, loan: Loan, station: asyncio.AbstractEventLoop) -> None:
        self._device = device
        self._loan = loan
        self._station = station
        self.device_id = device.device_id
        self.model = device.model_name
        self.rate_hz = device.rate_hz
        self.dof = device.dof
        self.is_twin = device.is_twin

    async def scene(self, scene: Mapping[str, Any]) -> None:
        """Renders a scene, flat as ``TwinRun.scene`` takes it; in force when this returns."""
        await self._at_station(self._loan.scene(scene))

    async def record(self, duration_s: float) -> NDArray[Any]:
        """The next ticks without a gap, shape (ticks,)."""
        return await self._at_station(recorded(self._device, duration_s))

    async def hand(self, script: Mapping[str, Any]) -> None:
        """Tells a twin's hand what to do."""
        if not self.is_twin:
            detail = f"{self.device_id} is driven by hardware: nobody can tell its hand what to do."
            raise Problem("not-a-twin", detail, device_id=self.device_id)
        await self._at_station(self._loan.hand(script))

    async def _at_station(self, work: Coroutine[Any, Any, Result]) -> Result:
        """Does something in the thread that the device belongs to."""
        return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, self._station))


async def recorded(device: Device, duration_s: float) -> NDArray[Any]:
    """The next ticks of an enabled device. ``Problem``: device-not-enabled; experiment-failed for a gap."""
    wanted = max(1, round(duration_s * device.rate_hz))
    clock = asyncio.get_running_loop()
    until_s = clock.time() + duration_s + LATE_S
    since = device.head()
    parts: list[NDArray[Any]] = []
    while (missing := wanted - sum(map(len, parts))) > 0:
        check_enabled(device)
        if clock.time() > until_s:
            raise Problem(
                "experiment-failed", f"{device.device_id} stopped ticking.", device_id=device.device_id
            )
        batch = device.read(since, min(missing, READ_MAX_TICKS))
        if batch.lost:
            detail = f"{batch.lost} ticks of {device.device_id} were overwritten before they were read."
            raise Problem("experiment-failed", detail, device_id=device.device_id)
        since += len(batch.records)
        parts.append(batch.records)
        await asyncio.sleep(POLL_S)
    return np.concatenate([np.empty(0, record_dtype()), *parts])


def check_enabled(device: Device) -> None:
    """``Problem`` (device-not-enabled) unless the device renders its scene."""
    state = device.snapshot().state
    if state != "enabled":
        raise Problem(
            "device-not-enabled",
            f"{device.device_id} is {state}.",
            device_id=device.device_id,
            current_state=state,
        )


async def run_on_device(
    order: Order, experiment: DeviceExperiment, device: Device, tell: Callable[[float, str], None]
) -> Finished:
    """Runs the experiment on the device, and puts back what the device rendered, also when cancelled."""
    check_libraries()
    station = asyncio.get_running_loop()
    async with device.lent(f"the experiment {experiment.name}") as loan:
        check_enabled(device)

        def report(fraction: float, doing: str) -> None:
            station.call_soon_threadsafe(tell, fraction, doing)

        session = _Session(order, experiment, LentBench(device, loan, station), report)
        thread = asyncio.ensure_future(asyncio.to_thread(session.run))
        thread.add_done_callback(_heard)
        try:
            return await asyncio.shield(thread)
        except asyncio.CancelledError:
            session.cancel()
            # One that does not listen goes on alone: the loan is over, so it reaches the device no more.
            await asyncio.wait({thread}, timeout=CANCEL_S)
            raise


def _heard(thread: asyncio.Future[Finished]) -> None:
    """Takes note of how a cancelled session ended, which nobody waits for."""
    if not thread.cancelled():
        thread.exception()


class _Session:
    """The experiment in its thread."""

    def __init__(
        self,
        order: Order,
        experiment: DeviceExperiment,
        bench: LentBench,
        report: Callable[[float, str], None],
    ) -> None:
        self._order = order
        self._experiment = experiment
        self._bench = bench
        self._cancelled = threading.Event()
        self._progress = Progress(report, self._cancelled)
        self._begun: tuple[asyncio.AbstractEventLoop, asyncio.Task[Finished]] | None = None

    def run(self) -> Finished:
        """Everything, in an event loop of this thread."""
        try:
            return asyncio.run(self._run())
        except asyncio.CancelledError:
            raise Cancelled from None

    def cancel(self) -> None:
        """Ends it at its next step; from the station's thread."""
        self._cancelled.set()
        if self._begun is not None:
            loop, task = self._begun
            # Its loop is closed once it has come to its end by itself.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(task.cancel)

    async def _run(self) -> Finished:
        task = asyncio.current_task()
        assert task is not None
        self._begun = asyncio.get_running_loop(), task
        self._progress.tell(0.0, "starting")
        order = self._order
        run = Run(order.experiment, order.settings, order.seed, progress=self._progress)
        outcome = await self._experiment.run_on(run, self._bench)
        return finish(order, outcome, device_id=self._bench.device_id)
