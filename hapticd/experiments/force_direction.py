"""WN Figs. 5 and 6: where the force of a held tip points, for walls all around it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.phantom_pose import PLANE, PhantomPose, in_plane
from hapticd.analysis.stiffness import direction_error_rad, locked_joints
from hapticd.experiments.bench import DeviceBench
from hapticd.experiments.clamped_phantom import IDEAL, ClampedPhantom
from hapticd.experiments.direction_bandwidth import Bandwidth, bandwidth
from hapticd.experiments.direction_on_device import measure_on
from hapticd.experiments.direction_series import Series, wall_angles
from hapticd.experiments.drive_tuning import MODEL, RESIDUAL, TUNING, tuned
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.force_direction_claims import claims, claims_on_device
from hapticd.experiments.force_direction_figure import draw
from hapticd.experiments.model_keys import model_keys
from hapticd.experiments.plane_wall import plane_wall
from hapticd.experiments.pose_parameter import POSE, pose_of
from hapticd.experiments.run import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Vector = NDArray[np.float64]

COLD: Mapping[str, Any] = {**IDEAL, "drive.thermal.winding_s": 1e6}
"""And windings that do not warm up: a warm one makes its joint softer, which inverse mapping does not see."""

MAPPINGS = ("transpose", "inverse")

RATE_HZ = 1000.0

FAST_HZ = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 110.0, 200.0, 400.0)
"""Frequencies at which the direction is looked at in motion."""


class ForceDirection:
    """24 walls that a held tip is inside of, with transpose and with inverse mapping."""

    name = "force-direction"
    title = "Direction of the force of a held tip"
    source = "WN Fig. 5, 6"
    models = (MODEL,)
    overrides: Mapping[str, Any] = COLD
    uncertain = (
        "kinematics.l1_m",
        "kinematics.l2_m",
        "drive.l_h",
        "estimator.lambda_rad_per_s",
        "twin.hand.clamp_stiffness_n_per_m",
    )
    on_device = True
    device_models = (MODEL,)
    parameters = (
        POSE,
        RESIDUAL,
        TUNING,
        Parameter(
            "depth_m", 5e-4, "m", "How deep the tip is in every wall", "chosen", 5e-5, 2e-2, uncertain=True
        ),
        Parameter("spacing_deg", 15.0, "°", "Angle from one wall normal to the next", "WN §VI", 1.0, 120.0),
        Parameter(
            "settle_s",
            0.1,
            "s",
            "From the wall to the measurement",
            "chosen, 50 time constants L/dR",
            0.01,
            5.0,
        ),
        Parameter("measure_s", 0.2, "s", "Time over which the force is averaged", "chosen", 0.005, 5.0),
        Parameter(
            "rest_s", 0.5, "s", "Pause between walls on a device, for its windings", "chosen", 0.0, 60.0
        ),
        Parameter("motion", True, "", "Whether the direction in motion is measured too", "chosen"),
    )

    def run(self, run: Run) -> Outcome:
        """Measures both mappings on the ideal twin and on one with ripple, friction and heat."""
        pose = PhantomPose.of_model(run.model(MODEL, tuned(run)), pose_of(run))
        ideal = {mapping: series(run, pose, mapping, {}) for mapping in MAPPINGS}
        imperfect = {mapping: series(run, pose, mapping, imperfections()) for mapping in MAPPINGS}
        moving = bandwidth(run, pose, np.array(FAST_HZ), RATE_HZ) if run.flag("motion") else None
        results = {
            "tip_m": pose.tip.tolist(),
            "coupling_deg": float(np.degrees(pose.coupling_rad)),
            **{name: one.numbers() for name, one in ideal.items()},
            "imperfect": {name: one.numbers() for name, one in imperfect.items()},
            **({"motion": moving.numbers()} if moving else {}),
        }

        def figure(figure: Figure) -> None:
            draw(figure, ideal, imperfect, moving)

        return Outcome(
            results, claims(pose, ideal, imperfect, moving), figure, _traces(ideal, imperfect, moving)
        )

    async def run_on(self, run: Run, bench: DeviceBench) -> Outcome:
        """Puts walls around the locked tip of a device, and reads its force sensor or its motors."""
        found = await measure_on(run, bench)
        results = {
            "force_from": found.force_from,
            "tip_m": found.tip.tolist(),
            "tip_moved_m": found.moved_m,
            **{name: one.numbers() for name, one in found.series.items()},
        }

        def figure(figure: Figure) -> None:
            draw(figure, found.series, {}, None)

        traces = {name: one.trace() for name, one in found.series.items()}
        return Outcome(results, claims_on_device(found), figure, traces)


def series(run: Run, pose: PhantomPose, mapping: str, overrides: Mapping[str, Any]) -> Series:
    """Every wall on a twin of its own, so that no winding is warm from the wall before."""
    angles = wall_angles(run.number("spacing_deg"))

    def force(angle_rad: float) -> Vector:
        phantom = ClampedPhantom(run, pose.q, {**tuned(run), **overrides})
        n = in_plane(angle_rad)
        wall = plane_wall(n, float(n @ phantom.home) + run.number("depth_m"))
        scene = {"mapping": mapping, "walls": [wall]}
        return phantom.measure(scene, run.number("settle_s"), run.number("measure_s"))[1]

    forces = np.array(run.map(force, [float(angle) for angle in angles], doing=mapping, until=0.9))
    return Series(angles, forces[:, list(PLANE)], closed_form(pose, mapping))


def closed_form(pose: PhantomPose, mapping: str) -> Callable[[Vector], Vector]:
    """The error by wall normal: that of K_inv for the inverse, none for the transpose."""
    if mapping == "transpose":
        return np.zeros_like
    return partial(direction_error_rad, locked_joints(pose.plane_jacobian, pose.plane_k_q))


def imperfections() -> dict[str, Any]:
    """What the ideal twin leaves out, as the device file has it."""
    return {key: model_keys(MODEL)[key].default for key in COLD}


def _traces(
    ideal: Mapping[str, Series], imperfect: Mapping[str, Series], moving: Bandwidth | None
) -> dict[str, Mapping[str, Vector]]:
    return {
        **{name: one.trace() for name, one in ideal.items()},
        **{f"imperfect-{name}": one.trace() for name, one in imperfect.items()},
        **({"motion": moving.trace()} if moving else {}),
    }


EXPERIMENT = ForceDirection()
