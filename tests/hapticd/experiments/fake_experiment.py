"""A small experiment on the twin of the HHD, for tests of what runs experiments."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hapticd.experiments.bench import DeviceBench
from hapticd.experiments.catalogue import CATALOGUE
from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.flat_wall import rigid_plane
from hapticd.problem import Problem

if TYPE_CHECKING:
    import pytest
    from matplotlib.figure import Figure

NAME = "fake"
IMPORT_STRING = f"{__name__}:EXPERIMENT"
BOUND_M_PER_S = 0.25
PUSH_ON = rigid_plane([0.0, 1.0, 0.0], 0.15)


class FakeExperiment:
    """Lets the hand hold the twin's tip for a while, ``runs`` times."""

    name = NAME
    title = "A hand that holds"
    source = "no paper"
    models: tuple[str, ...] = ("hhd", "phantom-1.0")
    overrides: ClassVar[dict[str, Any]] = {"hhd:twin.hand.mass_kg": 1.3}
    uncertain: tuple[str, ...] = ("hhd:twin.hand.mass_kg", "twin.friction.coulomb_nm")
    on_device = True
    device_models: tuple[str, ...] = ("hhd", "phantom-1.0")
    parameters: tuple[Parameter, ...] = (
        Parameter("speed_m_per_s", 0.25, "m/s", "Speed", "assumed", minimum=0.0, maximum=2.0, uncertain=True),
        Parameter("runs", 2, "1", "How many runs", "assumed", minimum=1, maximum=10),
        Parameter(
            "how", "well", "", "How it goes", "assumed", choices=("well", "badly", "crash", "long", "refused")
        ),
        Parameter("noisy", True, "", "Whether the seed matters", "assumed"),
        Parameter("axis", (1.0, 0.0), "1", "A direction", "assumed", minimum=-1.0, maximum=1.0),
    )

    def run(self, run: Run) -> Outcome:
        """Runs the twins, or goes wrong in the way that ``how`` says."""
        how = run.word("how")
        if how == "badly":
            raise Problem("parameter-invalid", "It goes badly.", hint="Let it go well.")
        if how == "crash":
            raise RuntimeError("the ground is gone")
        if how == "refused":
            twin = run.twin("hhd")
            twin.estop()
            twin.enable()
        while how == "long":
            run.progress(0.5, "waiting")
            time.sleep(0.01)

        def hold(index: int) -> Any:
            twin = run.twin("hhd", seed=run.seed + index if run.flag("noisy") else 1)
            return twin.run(0.05)

        return self._outcome(run, run.map(hold, range(run.integer("runs")), doing="holding"))

    async def run_on(self, run: Run, bench: DeviceBench) -> Outcome:
        """Renders a wall and records what the device does."""
        await bench.scene({"walls": [PUSH_ON]})
        await bench.hand({"type": "hold", "stiff": True})
        run.progress(0.5, "recording")
        if run.word("how") == "long":
            await asyncio.sleep(60.0)
        return self._outcome(run, [await bench.record(0.05)])

    def _outcome(self, run: Run, records: list[Any]) -> Outcome:
        speed_m_per_s = run.number("speed_m_per_s")
        force_n = [float(record["tip_force_n"][-1, 0]) for record in records]

        def figure(figure: Figure) -> None:
            axes = figure.subplots()
            axes.plot(force_n, marker="o")
            axes.set_axis_off()  # ticks are most of the work of drawing

        claims = (
            judged(
                "it is slow",
                "no paper",
                f"≤ {BOUND_M_PER_S} m/s",
                f"{speed_m_per_s:.3f} m/s",
                holds=speed_m_per_s <= BOUND_M_PER_S,
            ),
            undecidable("it is felt", "no paper", "yes", "–", "nobody was asked"),
        )
        results = {
            "z": np.float64(1.0),
            "a": {"infinite": np.inf, "tip": np.array(force_n)},
            "draw": run.rng().random(),
        }
        return Outcome(
            results, claims, figure, {"ticks": records[0], "runs": {"tip_force_n": np.array(force_n)}}
        )


EXPERIMENT = FakeExperiment()


def put_alone_into_catalogue(monkeypatch: pytest.MonkeyPatch) -> FakeExperiment:
    """Makes it the one experiment there is, until the test is over."""
    for name in list(CATALOGUE):
        monkeypatch.delitem(CATALOGUE, name)
    monkeypatch.setitem(CATALOGUE, NAME, IMPORT_STRING)
    return EXPERIMENT
