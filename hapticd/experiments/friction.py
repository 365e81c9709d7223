"""KS Figs. 11, 12: a hand rubs along a wall, weakly and strongly pressed; friction by motors or brakes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.friction_claims import claims
from hapticd.experiments.friction_drag import MODEL, STRENGTHS, SYSTEMS, dragged, largest_stable_n_per_m
from hapticd.experiments.friction_figure import draw
from hapticd.experiments.friction_rule import RULES, let_go
from hapticd.experiments.run import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Friction:
    """Weak and strong normal force × friction by the motors, friction by the brakes."""

    name = "friction"
    title = "Friction of a wall: by motors, by brakes"
    source = "KS Figs. 10–12, §5"
    models = (MODEL,)
    # The own friction of the mechanism, in KS's words a little: with more, its 1 N·m of KS's wall contacts
    # would be as large as the friction that is rendered.
    overrides: Mapping[str, Any] = {"twin.friction.coulomb_nm": [0.2, 0.2, 0.0]}
    uncertain = (
        "brakes.torque_max_nm",
        "brakes.lag_s",
        "brakes.dead_time_s",
        "estimator.lambda_rad_per_s",
        "drive.lag_s",
        "twin.friction.coulomb_nm",
        "twin.friction.viscous_nm_s_per_rad",
        "twin.linkage.tip_kg",
        "twin.linkage.rotor_kg_m2",
        "twin.sensor.noise_n",
        "twin.hand.mass_kg",
        "twin.hand.grip_stiffness_n_per_m",
        "twin.hand.arm_stiffness_n_per_m",
        "twin.hand.arm_damping_n_s_per_m",
    )
    on_device = False
    parameters = (
        Parameter("static", 0.6, "1", "μ_s of the wall", "assumed: KS give no number", 0.05, 1.5),
        Parameter(
            "kinetic", 0.4, "1", "μ_k of the wall, at most μ_s", "assumed: KS give no number", 0.05, 1.5
        ),
        Parameter(
            "weak_push_n", 20.0, "N", "Normal force of the weak case", "KS Fig. 11: below 25 N", 2.0, 25.0
        ),
        Parameter(
            "strong_push_n", 48.0, "N", "Normal force of the strong case", "KS Fig. 12: over 40 N", 40.0, 90.0
        ),
        Parameter("surface_y_m", 0.19, "m", "Where the wall stands; its normal is +y", "chosen", 0.16, 0.26),
        Parameter("way_m", 0.1, "m", "Way of the hand along the wall", "chosen", 0.04, 0.2),
        Parameter("pull_s", 2.0, "s", "Time for it", "chosen", 0.5, 10.0),
        Parameter(
            "coast_m_per_s", 0.15, "m/s", "Speed at which the printed rule is let go", "chosen", 0.02, 0.5
        ),
        Parameter(
            "mass_kg", 1.0, "kg", "Tip mass in the simulation of the printed rule", "as tip.mass_kg", 0.1, 5.0
        ),
        Parameter("rate_hz", 1000.0, "Hz", "Rate of the loop", "the daemon's default", 500.0, 4000.0),
    )

    def run(self, run: Run) -> Outcome:
        """Rubs in every case, finds the stiffest wall each system stands, and tries the rule as printed."""
        cases = [(strength, system) for strength in STRENGTHS for system in SYSTEMS]
        found = run.map(lambda case: dragged(run, *case), cases, doing="rubbing", until=0.4)
        drags = dict(zip(cases, found, strict=True))
        stiffest = dict(
            zip(SYSTEMS, [largest_stable_n_per_m(run, system) for system in SYSTEMS], strict=True)
        )
        coasts = {rule: let_go(run, rule) for rule in RULES}
        results = {
            **{
                strength: {system: drags[strength, system].numbers() for system in SYSTEMS}
                for strength in STRENGTHS
            },
            "largest_stable_stiffness_n_per_m": stiffest,
            "let_go": {rule: coast.numbers() for rule, coast in coasts.items()},
        }

        def figure(figure: Figure) -> None:
            draw(figure, drags, coasts)

        traces: dict[str, Any] = {
            f"{strength}-{system}": drag.trace() for (strength, system), drag in drags.items()
        }
        traces.update({f"let-go-{rule}": coast.trace() for rule, coast in coasts.items()})
        return Outcome(results, claims(drags, stiffest, coasts), figure, traces)


EXPERIMENT = Friction()
