"""The picture of the stiffness at the tip: ellipse and ball at a pose, and the ball everywhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.phantom_pose import PhantomPose
from hapticd.analysis.stiffness import locked_joints
from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.stiffness_probe import Probe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {"inverse": "K_inv, inverse mapping", "transpose": "K_trans, transpose mapping"}


def draw(
    figure: Figure,
    pose: PhantomPose,
    probes: Mapping[str, Probe],
    everywhere: Sequence[PhantomPose],
    found: Mapping[str, NDArray[np.float64]],
) -> None:
    """Left the pose: lines are closed forms, marks the twin's force per millimetre. Right the workspace."""
    left, right = figure.subplots(1, 2, width_ratios=(5, 4))
    k_inv = locked_joints(pose.plane_jacobian, pose.plane_k_q)
    ball = probes["transpose"].stiffness.trace() / 2 * np.eye(2)
    for name, stiffness, colour in (("inverse", k_inv, COLOURS[1]), ("transpose", ball, COLOURS[0])):
        _draw_stiffness(left, stiffness, probes[name], LABELS[name], colour)
    turn = np.linspace(0, 2 * np.pi, 200)
    largest = np.linalg.eigvalsh(k_inv)[0] / 1e3
    bound = "largest ball with the base locked"
    left.plot(largest * np.cos(turn), largest * np.sin(turn), "--", color="#606060", linewidth=1, label=bound)
    reach = 1.45 * np.linalg.eigvalsh(k_inv)[-1] / 1e3
    left.set(xlim=(-reach, reach), ylim=(-reach, reach))
    left.set_aspect("equal")
    left.set(xlabel="force along x, N per mm", ylabel="force along z, N per mm")
    left.set_title(f"Base locked, q3 − q2 = {np.degrees(pose.coupling_rad):.0f}°. Marks: twin", fontsize=9.5)
    left.legend(loc="upper right")
    _draw_workspace(figure, right, pose, everywhere, found)


def _draw_stiffness(
    axes: Axes, stiffness: NDArray[np.float64], probe: Probe, label: str, colour: str
) -> None:
    turn = np.linspace(0, 2 * np.pi, 200)
    line = stiffness @ np.stack([np.cos(turn), np.sin(turn)]) / 1e3
    axes.plot(*line, color=colour, linewidth=1.4, label=label)
    per_mm = -probe.force_n.T / np.linalg.norm(probe.displacement_m, axis=1) / 1e3
    axes.plot(*per_mm, "o", color=colour, markersize=4.5)


def _draw_workspace(
    figure: Figure,
    axes: Axes,
    pose: PhantomPose,
    everywhere: Sequence[PhantomPose],
    found: Mapping[str, NDArray[np.float64]],
) -> None:
    shown = axes.scatter(
        1e3 * found["x_m"],
        1e3 * found["z_m"],
        c=found["k_c_n_per_m"] / 1e3,
        s=9,
        cmap="viridis",
        linewidths=0,
    )
    figure.colorbar(shown, ax=axes, label="isotropic stiffness k_c, N/mm", shrink=0.8)
    _draw_linkage(axes, pose)
    axes.set_aspect("equal")
    axes.set(xlabel="tip x, mm", ylabel="tip z, mm")
    axes.set_title(f"Largest isotropic stiffness over {len(everywhere)} poses", fontsize=9.5)


def _draw_linkage(axes: Axes, pose: PhantomPose) -> None:
    """Upper link and forearm of the pose, from the shoulder to the tip."""
    upper = pose.jacobian[:, 1]
    elbow = np.array([upper[2], 0.0, -upper[0]])  # ∂x/∂q2 turned back by 90°
    points = 1e3 * np.stack([np.zeros(3), elbow, pose.tip])
    axes.plot(points[:, 0], points[:, 2], "-o", color="#D55E00", linewidth=2, markersize=4, label="linkage")
    axes.legend(loc="upper left")
