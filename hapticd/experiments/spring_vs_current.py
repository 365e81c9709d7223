"""The spring drive against a current amplifier with a digital spring: how stiff, how passive."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.drive_contact import JOINT, touches
from hapticd.experiments.drive_limits import COLUMNS, Bench, Limits, tip_drive
from hapticd.experiments.drive_tuning import MODEL, RESIDUAL, TUNING, tuned
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.spring_vs_current_claims import claims
from hapticd.experiments.spring_vs_current_figure import draw

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROTOR_PER_METRE = 7.0 / 0.14
"""ρ/l: how far the rotor turns for a metre of the tip, across the upper link."""

HAND = tuple(
    f"twin.hand.{name}"
    for name in (
        "mass_kg",
        "grip_stiffness_n_per_m",
        "grip_damping_n_s_per_m",
        "arm_stiffness_n_per_m",
        "arm_damping_n_s_per_m",
    )
)


class SpringVsCurrent:
    """Largest stable and largest passive stiffness over rate and delay, and one contact on both."""

    name = "spring-vs-current"
    title = "Spring drive against current amplifier"
    source = "WN abstract, §I, §II"
    models = (MODEL,)
    overrides: Mapping[str, Any] = {}
    uncertain = HAND
    on_device = False
    parameters = (
        RESIDUAL,
        TUNING,
        Parameter(
            "mass_kg", 0.075, "kg", "Apparent mass of the tip", "maker's figure", 0.005, 5.0, uncertain=True
        ),
        Parameter(
            "viscous_n_s_per_m",
            0.1,
            "N·s/m",
            "Viscous friction at the tip",
            "assumed",
            0.001,
            20.0,
            uncertain=True,
        ),
        Parameter(
            "coulomb_n", 0.04, "N", "Dry friction at the tip", "maker's figure", 0.0, 10.0, uncertain=True
        ),
        Parameter("quantum_m", 31e-6, "m", "One encoder count at the tip", "by ratio and counts", 1e-8, 1e-3),
        Parameter(
            "lambda_rad_per_s",
            1256.6,
            "rad/s",
            "Velocity filter",
            "assumed 200 Hz",
            50.0,
            1e6,
            uncertain=True,
        ),
        Parameter(
            "current_lag_s", 0.0, "s", "Lag of the current amplifier", "ideal, in its favour", 0.0, 0.01
        ),
        Parameter(
            "rate_hz", 1000.0, "Hz", "Rate at which both drives are compared", "the daemon's", 250.0, 20000.0
        ),
        Parameter(
            "delay_ticks", 1, "ticks", "Delay at which they are compared", "an exchange takes one", 1, 5
        ),
        Parameter("rates", 13, "1", "Rates in the curves, 250 Hz to 16 kHz", "chosen", 3, 61),
        Parameter(
            "approach_m_per_s",
            0.2,
            "m/s",
            "Speed of the hand at the wall",
            "chosen",
            0.02,
            1.0,
            uncertain=True,
        ),
        Parameter(
            "travel_m", 0.03, "m", "Path of the hand, half of it behind the wall", "chosen", 0.005, 0.06
        ),
        Parameter("duration_s", 1.0, "s", "Time of the contact", "chosen", 0.3, 10.0),
        Parameter("force_max_n", 8.5, "N", "Largest force", "maker's figure", 1.0, 100.0),
    )

    def run(self, run: Run) -> Outcome:
        """Limits by linear analysis, then the contact on the twin and in a simulation of one axis."""
        bench = bench_of(run)
        rates = np.geomspace(250.0, 16000.0, run.integer("rates"))
        limits = [limits_at(bench, rates, delay) for delay in range(run.integer("delay_ticks") + 1)]
        rate_hz = run.number("rate_hz")
        compared = [
            dict(zip(COLUMNS, bench.largest(rate_hz, one.delay_ticks), strict=True)) for one in limits
        ]
        run.progress(0.3, "touching")
        felt = touches(run)
        results = {
            "series_stiffness_n_per_m": bench.series_n_per_m,
            "tuned_stiffness_n_per_m": run.number(TUNING.name) * bench.series_n_per_m,
            "by_resolution_n_per_m": bench.by_resolution_n_per_m,
            "limits": [one.numbers() for one in limits],
            "compared": [
                {"rate_hz": rate_hz, "delay_ticks": one.delay_ticks, **row}
                for one, row in zip(limits, compared, strict=True)
            ],
            "contact": {name: touch.numbers() for name, touch in felt.items()},
        }

        def figure(figure: Figure) -> None:
            draw(figure, bench, limits, felt, rate_hz)

        traces = {f"delay-{one.delay_ticks}": one.trace() for one in limits}
        return Outcome(
            results,
            claims(results),
            figure,
            {**traces, **{name: touch.trace() for name, touch in felt.items()}},
        )


def bench_of(run: Run) -> Bench:
    """Both drives at the same tip."""
    drive = SpringDrive.of_model(run.model(MODEL, tuned(run)), JOINT)
    series_n_per_m, series_lag_s = tip_drive(drive, ROTOR_PER_METRE)
    return Bench(
        mass_kg=run.number("mass_kg"),
        viscous_n_s_per_m=run.number("viscous_n_s_per_m"),
        coulomb_n=run.number("coulomb_n"),
        quantum_m=run.number("quantum_m"),
        lambda_rad_per_s=run.number("lambda_rad_per_s"),
        current_lag_s=run.number("current_lag_s"),
        series_n_per_m=series_n_per_m,
        series_lag_s=series_lag_s,
    )


def limits_at(bench: Bench, rates: Any, delay_ticks: int) -> Limits:
    """Every limit over the rates at one delay."""
    rows = np.array([bench.largest(float(rate), delay_ticks) for rate in rates])
    return Limits(delay_ticks, rates, dict(zip(COLUMNS, rows.T, strict=True)))


EXPERIMENT = SpringVsCurrent()
