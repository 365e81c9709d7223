"""Where a rigid wall is stable: over stiffness and damping, or over the tuning of the spring drive."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.stability_lines import Lines, lines
from hapticd.experiments.stability_map_claims import claims
from hapticd.experiments.stability_map_figure import draw
from hapticd.experiments.stability_sheet import Sheet, coupling_sheet, spring_sheet, tuning_sheet
from hapticd.experiments.stability_survey import CYCLING, SETTLED, UNSTABLE, Survey, Trial, surveyed
from hapticd.model import Model

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HHD, PHANTOM = "hhd", "phantom-1.0"

COULOMB = "twin.friction.coulomb_nm"
SLIPPERY = 0.1
"""Share of dry friction, motors' and brakes', in the second look without damping."""

MAP_SHARE = 0.9
"""Of the progress."""


class StabilityMap:
    """Pushes the twin's hand into a rigid wall at every point of a grid, and lays theory over it."""

    name = "stability-map"
    title = "Stable region of a wall"
    source = "physics §2.2, §6, §9; Colgate & Schenkel 1994"
    models = (HHD, PHANTOM)
    overrides: Mapping[str, Any] = {}
    uncertain = (f"hhd:{COULOMB}", "hhd:drive.lag_s", "hhd:twin.hand.mass_kg")
    on_device = False
    parameters = (
        Parameter("device", HHD, "", "Which twin", "chosen", choices=(HHD, PHANTOM)),
        Parameter(
            "law",
            "motion",
            "",
            "hhd: a rigid wall on the virtual coupling, or a spring of its own",
            "chosen",
            choices=("motion", "spring"),
        ),
        Parameter("passivity", False, "", "Whether passivity watches the wall", "KS §3"),
        Parameter("rate_hz", 1000.0, "Hz", "Rate of the loop", "assumed: KS and WN give none", 200.0, 5000.0),
        Parameter("stiffness_n_per_m", (1e3, 5e5), "N/m", "hhd: least and largest K", "chosen", 1e2, 1e7),
        Parameter("damping_n_s_per_m", (0.0, 700.0), "N·s/m", "hhd: least and largest B", "chosen", 0.0, 1e4),
        Parameter("k_p_share", (0.1, 2.5), "1", "phantom: K_P over k_T dR/L", "chosen", 0.01, 10.0),
        Parameter("r_hat_share", (0.8, 0.985), "1", "phantom: R̂/R", "WN give none", 0.0, 0.995),
        Parameter(
            "push_share", 0.25, "1", "Force of the push over the device's largest", "chosen", 0.01, 1.0
        ),
        Parameter("columns", 61, "1", "Dampings or R̂/R", "chosen", 2, 400),
        Parameter("rows", 60, "1", "Stiffnesses or K_P", "chosen", 2, 400),
    )

    def run(self, run: Run) -> Outcome:
        """Surveys the grid, adds what theory says, and judges both."""
        trial = Trial(run.number("rate_hz"), run.number("push_share"), run.flag("passivity"))
        survey = surveyed(run, _sheet(run), trial, MAP_SHARE)
        found, slippery = lines(survey), None
        if run.word("device") == HHD and not trial.passivity:
            slippery = surveyed(run, _slippery(run), trial, 1.0)

        def figure(figure: Figure) -> None:
            draw(figure, survey, found, trial)

        judged = claims(survey, found, slippery, watched=trial.passivity)
        return Outcome(_results(survey, found, slippery), judged, figure, {"map": _trace(survey)})


def _sheet(run: Run) -> Sheet:
    columns, rate_hz = run.integer("columns"), run.number("rate_hz")
    if run.word("device") == PHANTOM:
        r_hat_share = np.linspace(*_ends(run, "r_hat_share"), columns)
        return tuning_sheet(run.model(PHANTOM), rate_hz, _rows(run, "k_p_share"), r_hat_share)
    damping = np.linspace(*_ends(run, "damping_n_s_per_m"), columns)
    return _hhd(run, run.model(HHD), damping)


def _hhd(run: Run, model: Model, damping: NDArray[np.float64]) -> Sheet:
    make = spring_sheet if run.word("law") == "spring" else coupling_sheet
    return make(model, run.number("rate_hz"), _rows(run, "stiffness_n_per_m"), damping)


def _slippery(run: Run) -> Sheet:
    """The column without damping once more, with a tenth of the dry friction."""
    model = run.model(HHD)
    bearings = json.loads(model.twin_json)["friction"]["coulomb_nm"]
    drag = json.loads(model.device_json)["brakes"]["drag_nm"]
    less = {COULOMB: _less(bearings), "brakes.drag_nm": _less(drag)}
    return _hhd(run, model.changed(less), np.zeros(1))


def _less(torque_nm: list[float]) -> list[float]:
    return [SLIPPERY * value for value in torque_nm]


def _rows(run: Run, name: str) -> NDArray[np.float64]:
    return np.geomspace(*_ends(run, name), run.integer("rows"))


def _ends(run: Run, name: str) -> tuple[float, float]:
    low, high = run.vector(name)
    return low, high


def _results(survey: Survey, found: Lines, slippery: Survey | None) -> dict[str, Any]:
    sheet = survey.sheet
    counts = {
        "settled": int((survey.outcome == SETTLED).sum()),
        "limit_cycle": int((survey.outcome == CYCLING).sum()),
        "unstable": int((survey.outcome == UNSTABLE).sum()),
    }
    results: dict[str, Any] = {
        "runs": survey.outcome.size + (0 if slippery is None else slippery.outcome.size),
        "points": counts,
        "bound_m": survey.bound_m,
        "across": {"label": sheet.across_label, "values": sheet.across.tolist()},
        "up": {"label": sheet.up_label, "values": sheet.up.tolist()},
        "largest_settled": found.settled_up.tolist(),
        "largest_linear": found.linear.tolist(),
        "largest_passive": found.passive.tolist(),
    }
    if slippery is not None:
        results["largest_settled_slippery"] = lines(slippery).settled_up.tolist()
    return results


def _trace(survey: Survey) -> dict[str, NDArray[np.float64]]:
    across, up = np.meshgrid(survey.sheet.across, survey.sheet.up)
    return {
        "across": across.ravel(),
        "up": up.ravel(),
        "motion_m": survey.motion_m.ravel(),
        "outcome": survey.outcome.ravel().astype(np.float64),
    }


EXPERIMENT = StabilityMap()
