"""KS Fig. 5: where one motor and one brake can push, in compression and in release."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hapticd.experiments.brake_release_claims import claims
from hapticd.experiments.brake_release_figure import draw
from hapticd.experiments.brake_release_poses import closed_forms
from hapticd.experiments.brake_release_press import CASES, pressed
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODEL = "hhd"


class BrakeRelease:
    """A wall pressed and let go: by a motor and a brake on one joint each, and by both on both."""

    name = "brake-release"
    title = "Direction of the force while a wall is pressed and let go"
    source = "KS Fig. 5, §3"
    models = (MODEL,)
    # Nothing but motors and ideal brakes acts on the tip, so that their force is the one on the clamp.
    overrides: Mapping[str, Any] = {
        "twin.friction.coulomb_nm": [0.0, 0.0, 0.0],
        "twin.brake.ripple": 0.0,
        "twin.brake.hysteresis_scale": 0.0,
        "brakes.hysteresis": 0.0,
        "brakes.drag_nm": [0.0, 0.0, 0.0],
        "twin.sensor.bias_n": [0.0, 0.0, 0.0],
    }
    uncertain = ("brakes.lag_s", "twin.brake.lag_scale", "drive.lag_s")
    on_device = False
    parameters = (
        Parameter("x_m", 0.0, "m", "Tip while pressed, along the wall", "KS Fig. 5", -0.15, 0.15),
        Parameter("y_m", 0.2, "m", "Surface of the wall, whose normal is −y", "KS Fig. 5", 0.12, 0.28),
        Parameter("depth_m", 0.02, "m", "Depth to which the wall is pressed", "chosen", 0.002, 0.05),
        Parameter("stiffness_n_per_m", 1500.0, "N/m", "Stiffness of the wall", "chosen", 100.0, 3000.0),
        Parameter("press_s", 1.0, "s", "Time for pressing, and for letting go", "chosen", 0.3, 5.0),
    )

    def run(self, run: Run) -> Outcome:
        """Presses and lets go on the twin with each set of actuators; beside it the closed form."""
        presses = run.map(lambda case: pressed(run, case), CASES, doing="pressing")
        cases = dict(zip(CASES, presses, strict=True))
        poses = closed_forms(run.model(MODEL).device_json)
        results = {
            **{name: case.numbers() for name, case in cases.items()},
            "closed_form": [pose.numbers() for pose in poses],
        }

        def figure(figure: Figure) -> None:
            draw(figure, cases, poses)

        traces = {name: case.trace() for name, case in cases.items()}
        return Outcome(results, claims(cases, poses), figure, traces)


EXPERIMENT = BrakeRelease()
