"""WN Fig. 2: the stiffness of a spring drive over frequency, in closed form and from the twin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.bench import DeviceBench
from hapticd.experiments.bode_device_claims import claims_on_device
from hapticd.experiments.bode_device_figure import draw_on_device
from hapticd.experiments.bode_on_device import PROBE, measure_on
from hapticd.experiments.drive_tuning import MODEL, RESIDUAL, TUNING
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.shaker import CLEAN
from hapticd.experiments.stiffness_bode_claims import claims
from hapticd.experiments.stiffness_bode_figure import draw
from hapticd.experiments.stiffness_curve import SETTINGS, drive_of, measured_curves
from hapticd.experiments.stiffness_side_tests import compliant, drift, free_space

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class StiffnessBode:
    """K_θ(s) of the bare motor, of the spring drive, and with proportional and derivative compensation."""

    name = "stiffness-bode"
    title = "Stiffness of one spring drive over frequency"
    source = "WN Fig. 2, eq. 4–17"
    models = (MODEL,)
    overrides: Mapping[str, Any] = CLEAN
    uncertain = ("estimator.lambda_rad_per_s", "drive.l_h", "drive.k_t_nm_per_a")
    on_device = True
    device_models = (MODEL, "hhd")
    parameters = (
        RESIDUAL,
        TUNING,
        Parameter(
            "k_d_share",
            1.0,
            "1",
            "K_D as a share of k_T, in the fourth curve",
            "assumed: WN give no number",
            minimum=0.0,
            maximum=5.0,
            uncertain=True,
        ),
        Parameter(
            "rate_hz",
            8000.0,
            "Hz",
            "Rate of the compensation in the four curves",
            "fast, for the continuous eq. 12",
            minimum=1000.0,
            maximum=20000.0,
        ),
        Parameter(
            "servo_rate_hz",
            1000.0,
            "Hz",
            "Rate of the compensation in the curve with P once more",
            "the daemon's default; WN give no rate",
            minimum=250.0,
            maximum=20000.0,
        ),
        Parameter("lowest_hz", 0.5, "Hz", "Lowest frequency", "chosen", minimum=0.05, maximum=10.0),
        Parameter("highest_hz", 3500.0, "Hz", "Highest frequency", "chosen", minimum=100.0, maximum=10000.0),
        Parameter("points", 15, "1", "Frequencies on each curve", "chosen", minimum=4, maximum=200),
        Parameter("amplitude_m", 1e-4, "m", "Stroke of the shaker at the tip", "chosen, linear", 1e-6, 1e-3),
        Parameter("eta", 0.3, "1", "η of the compliant wall", "chosen", minimum=0.05, maximum=0.95),
        PROBE,
    )

    def run(self, run: Run) -> Outcome:
        """Shakes the twin's tip at every frequency for every curve; then η, free space and drift."""
        curves = measured_curves(run)
        results = {
            "drive": {name: summary(drive_of(run, name)) for name in SETTINGS},
            "curves": {curve.name: curve.numbers() for curve in curves},
            "compliant": compliant(run),
            "free_space": free_space(run),
            "drift": drift(run),
        }
        drive = drive_of(run, "pd")

        def figure(figure: Figure) -> None:
            draw(figure, curves, drive)

        traces = {curve.name: curve.trace() for curve in curves}
        return Outcome(results, claims(curves, drive, results), figure, traces)

    async def run_on(self, run: Run, bench: DeviceBench) -> Outcome:
        """Moves the set-point of a device whose tip is locked, and reads what its motors give."""
        found = await measure_on(run, bench)
        results = {
            "force_from": found.motors.force_from,
            "stiffness_n_per_m": found.k_c,
            "tip_m": found.tip.tolist(),
            "tip_moved_m": found.moved_m,
            "limits": found.limits,
            **{name: series.numbers() for name, series in found.series.items()},
        }

        def figure(figure: Figure) -> None:
            draw_on_device(figure, found)

        traces = {name: series.trace() for name, series in found.series.items()}
        return Outcome(results, claims_on_device(found), figure, traces)


def summary(drive: SpringDrive) -> dict[str, float]:
    """The numbers of a drive, at the rotor."""
    return {
        "residual_ohm": drive.d_r,
        "k_p_v_per_rad": drive.k_p,
        "k_d_v_s_per_rad": drive.k_d,
        "lambda_rad_per_s": drive.lam,
        "k_dc_nm_per_rad": drive.k_dc,
        "k_hf_nm_per_rad": drive.k_hf,
        "corner_hz": drive.corner_hz,
        "passivity_margin": drive.passivity_margin,
    }


EXPERIMENT = StiffnessBode()
