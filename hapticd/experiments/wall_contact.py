"""KS Figs. 8, 9 and Table 1: a hard wall struck weakly and strongly, by three ways of rendering it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.wall_contact_approach import MODEL, approach
from hapticd.experiments.wall_contact_claims import claims
from hapticd.experiments.wall_contact_figure import draw
from hapticd.experiments.wall_contact_strike import STRENGTHS, WALLS, Strike, struck

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class WallContact:
    """Weak and strong approach × spring, spring with passivity control, damper with brakes."""

    name = "wall-contact"
    title = "Contact with a hard wall: active, passivity control, hybrid"
    source = "KS Figs. 8, 9, Table 1, §4"
    models = (MODEL,)
    # What fits KS's figures: 0.75 kg at the tip, brakes that begin late (physics §9, set R1), and the force
    # that the motors have at this pose, which is more than the daemon's own limit. No delay is unknown here.
    overrides: Mapping[str, Any] = {
        "brakes.dead_time_s": 0.058,
        "twin.brake.dead_time_s": 0.058,
        "twin.linkage.gear_ratio": 8.0,
        "limits.tip_force_n": 115.0,
        "tip.mass_kg": 0.7,
        "limits.delay_spare_ticks": 0,
    }
    uncertain = (
        "brakes.torque_max_nm",
        "brakes.lag_s",
        "brakes.dead_time_s",
        "twin.brake.dead_time_s",
        "estimator.lambda_rad_per_s",
        "drive.lag_s",
        "limits.tip_force_n",
        "twin.friction.coulomb_nm",
        "twin.friction.viscous_nm_s_per_rad",
        "twin.linkage.tip_kg",
        "twin.linkage.rotor_kg_m2",
        "twin.hand.mass_kg",
        "twin.hand.grip_stiffness_n_per_m",
        "twin.hand.grip_damping_n_s_per_m",
        "twin.hand.arm_stiffness_n_per_m",
        "twin.hand.arm_damping_n_s_per_m",
    )
    on_device = False
    parameters = (
        Parameter("stiffness_n_per_m", 150e3, "N/m", "Stiffness of the spring walls", "KS §4", 1e3, 1e6),
        Parameter(
            "coefficient_n_s3_per_m3", 1.6e6, "N·s³/m³", "C of the damper F = C v³", "KS §4, Fig. 7", 1e4, 1e8
        ),
        Parameter(
            "form",
            "explicit",
            "",
            "Form of the damper of `hybrid`: as printed, or implicit",
            "KS §4",
            choices=("explicit", "implicit"),
        ),
        Parameter("weak_speed_m_per_s", 0.25, "m/s", "Approach of the weak contact", "KS §4", 0.02, 1.0),
        Parameter("strong_speed_m_per_s", 1.5, "m/s", "Approach of the strong contact", "KS §4", 0.2, 3.0),
        Parameter(
            "weak_push_n", 27.0, "N", "Steady push of the weak contact", "physics §9", 2, 200, uncertain=True
        ),
        Parameter(
            "strong_push_n",
            60.0,
            "N",
            "Steady push of the strong contact",
            "physics §9",
            2,
            200,
            uncertain=True,
        ),
        Parameter("wall_y_m", 0.25, "m", "Where the wall stands; its normal is −y", "chosen", 0.15, 0.30),
        Parameter("start_y_m", 0.1, "m", "Where the hand sets out", "chosen", 0.09, 0.28),
        Parameter("watch_s", 1.2, "s", "Time watched after the contact", "KS Figs. 8, 9: 0.8 s", 0.4, 5.0),
        Parameter(
            "rate_hz", 2000.0, "Hz", "Rate of the loop", "fits Figs. 8(a), 9(a); not stated", 500.0, 4000.0
        ),
    )

    def run(self, run: Run) -> Outcome:
        """Strikes every wall weakly and strongly on the twin, then withdraws the hand."""
        scripts = {strength: approach(run, strength) for strength in STRENGTHS}
        cases = [(strength, wall) for strength in STRENGTHS for wall in WALLS]

        def strike(case: tuple[str, str]) -> Strike:
            return struck(run, case[1], scripts[case[0]])

        strikes = dict(zip(cases, run.map(strike, cases, doing="striking"), strict=True))
        results = {
            strength: {wall: strikes[strength, wall].numbers() for wall in WALLS} for strength in STRENGTHS
        }

        def figure(figure: Figure) -> None:
            draw(figure, strikes)

        traces = {f"{strength}-{wall}": strike.trace() for (strength, wall), strike in strikes.items()}
        return Outcome(results, claims(strikes), figure, traces)


EXPERIMENT = WallContact()
