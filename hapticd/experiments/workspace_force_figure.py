"""The picture of the workspace: smallest force, force ellipses, and the twin's pushes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hapticd.analysis.force_ellipse import ellipse_n
from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.workspace_map import WorkspaceMap
from hapticd.experiments.workspace_pushes import Pushes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM_PER_N = 0.2
"""Scale of forces drawn in the workspace."""

ELLIPSES = (5, 4)
"""Force ellipses drawn along x and y."""


def draw(figure: Figure, survey: WorkspaceMap, pushes: Pushes) -> None:
    """Motors on the left, brakes on the right."""
    figure.set_size_inches(12.0, 4.6)
    left, right = figure.subplots(1, 2)
    _draw_map(figure, left, survey, survey.motor_nm, f"Motors, {survey.motor_nm:g} N·m")
    _draw_pushes(left, pushes)
    inferred_nm = survey.brake_readings_nm["inferred"]
    _draw_map(figure, right, survey, inferred_nm, f"Brakes, {inferred_nm:g} N·m at the joint")


def _draw_map(figure: Figure, axes: Axes, survey: WorkspaceMap, torque_nm: float, what: str) -> None:
    x_mm, y_mm = 1e3 * survey.point_m.T
    smallest = survey.smallest_n(torque_nm)
    filled = axes.tricontourf(x_mm, y_mm, smallest, levels=12, cmap="cividis")
    figure.colorbar(filled, ax=axes, label="smallest force over all directions, N", shrink=0.75)
    for index in _spread(survey):
        ellipse = MM_PER_N * ellipse_n(survey.jacobian[index], torque_nm)
        axes.plot(x_mm[index] + ellipse[0], y_mm[index] + ellipse[1], color="white", linewidth=0.9)
    axes.set_aspect("equal")
    axes.set(xlabel="x, mm", ylabel="y, mm", xlim=(-240, 240), ylim=(40, 370))
    axes.set_title(f"{what}: at least {smallest.min():.1f} N", fontsize=10)


def _spread(survey: WorkspaceMap) -> list[int]:
    """Points of the map in the middle of equal fields."""
    low, high = survey.point_m.min(axis=0), survey.point_m.max(axis=0)
    columns, rows = ELLIPSES
    x = low[0] + (high[0] - low[0]) * (np.arange(columns) + 0.5) / columns
    y = low[1] + (high[1] - low[1]) * (np.arange(rows) + 0.5) / rows
    wanted = np.array([(a, b) for a in x for b in y])
    return [int(np.argmin(np.linalg.norm(survey.point_m - point, axis=1))) for point in wanted]


def _draw_pushes(axes: Axes, pushes: Pushes) -> None:
    start = 1e3 * pushes.point_m
    tip = start + MM_PER_N * pushes.force_n
    for begin, end in zip(start, tip, strict=True):
        axes.plot(*np.stack([begin, end]).T, color=COLOURS[1], linewidth=1.2)
    axes.plot([], [], color="white", label="‖τ‖ bounded (ellipse)")
    axes.plot([], [], color=COLOURS[1], label="pushes of the twin")
    axes.legend(loc="lower left", facecolor="#606060", labelcolor="white", fontsize=8)
