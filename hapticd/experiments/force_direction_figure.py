"""The picture of the force's direction: WN Fig. 6, WN Fig. 5 beside it, and the direction in motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from hapticd.experiments.direction_bandwidth import Bandwidth
from hapticd.experiments.direction_series import Series
from hapticd.experiments.figure_file import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {"transpose": "transpose", "inverse": "inverse"}
MARKS = {"transpose": ("o", COLOURS[0]), "inverse": ("s", COLOURS[1])}

WALL_ABOVE_RAD = 1.5 * np.pi


def draw(
    figure: Figure,
    series: Mapping[str, Series],
    imperfect: Mapping[str, Series],
    moving: Bandwidth | None,
) -> None:
    """Errors over the wall normal above; below the forces themselves, and the error over frequency."""
    grid = figure.add_gridspec(2, 2, height_ratios=(3, 2), width_ratios=(2, 3))
    errors = figure.add_subplot(grid[0, :])
    for name, one in series.items():
        _draw_errors(errors, one, name, filled=True)
    for name, one in imperfect.items():
        _draw_errors(errors, one, name, filled=False)
    errors.set(xlabel="angle of the wall normal, °", ylabel="error of the force's direction, °")
    errors.set_xticks(range(0, 361, 30))
    errors.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    if all(one.has(np.degrees(WALL_ABOVE_RAD)) for one in series.values()):
        _draw_vectors(figure.add_subplot(grid[1, 0]), series)
    if moving is not None:
        _draw_motion(figure.add_subplot(grid[1, 1]), moving)


def _draw_errors(axes: Axes, series: Series, name: str, *, filled: bool) -> None:
    mark, colour = MARKS[name]
    wall_deg = np.degrees(series.angle_rad)
    if filled:
        around_deg = np.linspace(0.0, 360.0, 361)
        line = np.degrees(series.closed_form(np.radians(around_deg)))
        axes.plot(around_deg, line, "-", color=colour, linewidth=1)
    label = LABELS[name] if filled else f"{LABELS[name]}, with ripple\nand friction"
    face = colour if filled else "none"
    axes.plot(
        wall_deg,
        np.degrees(series.error_rad),
        mark,
        color=colour,
        markerfacecolor=face,
        markersize=5 if filled else 6.5,
        label=label,
    )


def _draw_vectors(axes: Axes, series: Mapping[str, Series]) -> None:
    """Both forces under a horizontal wall above the device, scaled to one length (WN Fig. 5)."""
    axes.axhline(0.25, color="#404040", linewidth=3)
    axes.text(-0.95, 0.32, "wall", va="bottom")
    axes.plot([0, 0], [0, -1.15], ":", color="#404040", linewidth=1.2)
    for name, one in series.items():
        nearest = int(np.argmin(np.abs(np.angle(np.exp(1j * (one.angle_rad - WALL_ABOVE_RAD))))))
        force = one.force_n[nearest] / np.linalg.norm(one.force_n[nearest])
        arrow = {"arrowstyle": "-|>", "color": MARKS[name][1], "linewidth": 2}
        axes.annotate("", force, (0, 0), arrowprops=arrow)
        side = -0.08 if force[0] <= 0.02 else 0.08
        axes.text(force[0] + side, force[1], name, color=MARKS[name][1], ha="right" if side < 0 else "left")
    axes.plot(0, 0, "o", color="#000000", markersize=7)
    axes.set(xlim=(-1.1, 1.1), ylim=(-1.25, 0.55), xticks=[], yticks=[])
    axes.set_aspect("equal")
    axes.set_title("Forces under a wall above the tip; dotted: correct", fontsize=9)


def _draw_motion(axes: Axes, moving: Bandwidth) -> None:
    colour = COLOURS[0]
    axes.plot(moving.frequency_hz, np.degrees(moving.expected_rad), "-", color=colour, linewidth=1)
    axes.plot(moving.frequency_hz, np.degrees(moving.error_rad), "o", color=colour, label="transpose")
    axes.plot(
        moving.frequency_hz, np.degrees(moving.locked_rad), "--", color=COLOURS[1], label="locked joints"
    )
    axes.axvspan(20, 30, color="#E0E0E0", zorder=0, label="limit of kinesthesia [7]")
    axes.axhline(25, color="#808080", linestyle=":", linewidth=1, label="threshold of direction [2]")
    axes.set(xscale="log", xlabel="frequency of the tip's motion, Hz", ylabel="error, °")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
