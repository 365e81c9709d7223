"""KS Fig. 2: what force motors and brakes can put on the tip, over the workspace."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.workspace_force_claims import claims
from hapticd.experiments.workspace_force_figure import draw
from hapticd.experiments.workspace_map import surveyed
from hapticd.experiments.workspace_pushes import pushed

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODEL = "hhd"


class WorkspaceForce:
    """Force ellipses of motors and brakes over the workspace; pushes of the twin against a clamp."""

    name = "workspace-force"
    title = "Force of motors and brakes over the workspace"
    source = "KS Figs. 1, 2, §2.1, §2.2"
    models = (MODEL,)
    # The daemon's own limit on the tip force would hide what the motors can do.
    overrides: Mapping[str, Any] = {"limits.tip_force_n": 250.0}
    uncertain = ("twin.motor.torque_scale", "twin.friction.coulomb_nm", "brakes.drag_nm")
    on_device = False
    parameters = (
        Parameter(
            "motor_nm", 22.2, "N·m", "Largest joint torque of a motor", "KS §2.2: 4.44 N·m × 5", 1.0, 100.0
        ),
        Parameter("brake_nm", 4.0, "N·m", "Largest torque of a brake on its own shaft", "KS §2.2", 0.1, 50.0),
        Parameter("pulley_ratio", 5.0, "1", "Ratio of the pulleys", "KS §2.2", 1.0, 20.0),
        Parameter("x_max_m", 0.19, "m", "Half width of the workspace", "KS §2.1", 0.01, 0.3),
        Parameter("y_m", (0.09, 0.32), "m", "Nearest and farthest of the workspace", "KS §2.1", 0.02, 0.39),
        Parameter("step_m", 0.01, "m", "Grid of the map", "chosen", 0.002, 0.05),
        Parameter("directions", 36, "1", "Directions at every point of the map", "chosen", 8, 360),
        Parameter("push_directions", 8, "1", "Directions of the twin's pushes at each pose", "chosen", 4, 72),
    )

    def run(self, run: Run) -> Outcome:
        """Maps the workspace in closed form, then lets the twin push against a clamp at five poses."""
        survey = surveyed(run, run.model(MODEL).device_json)
        pushes = pushed(run, MODEL)
        results = {**survey.numbers(), "pushes": pushes.numbers()}

        def figure(figure: Figure) -> None:
            draw(figure, survey, pushes)

        return Outcome(
            results, claims(survey, pushes), figure, {"map": survey.trace(), "pushes": pushes.trace()}
        )


EXPERIMENT = WorkspaceForce()
