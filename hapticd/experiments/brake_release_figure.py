"""The picture of brake-release: the angle over time, and the forces of KS Fig. 5 at three poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from hapticd.experiments.brake_release_poses import FORCE_N, ReleasePose
from hapticd.experiments.brake_release_press import Press
from hapticd.experiments.figure_file import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {
    "one_of_each": "motor on joint 1, brake on joint 2",
    "motors": "motors alone",
    "motors_and_brakes": "motor and brake on each joint",
}


def draw(figure: Figure, cases: Mapping[str, Press], poses: Sequence[ReleasePose]) -> None:
    """Above the angle to the normal over time; below the closed form at each pose."""
    figure.set_size_inches(9.0, 6.5)
    grid = figure.add_gridspec(2, len(poses))
    _draw_angles(figure.add_subplot(grid[0, :]), cases)
    for column, pose in enumerate(poses):
        _draw_pose(figure.add_subplot(grid[1, column]), pose)


def _draw_angles(axes: Axes, cases: Mapping[str, Press]) -> None:
    for (name, press), colour in zip(cases.items(), COLOURS, strict=False):
        trace = press.trace()
        pushing = np.hypot(trace["force_x_n"], trace["force_y_n"]) > 0.5
        axes.plot(
            trace["t_s"],
            np.where(pushing & (trace["depth_m"] > 1e-3), trace["off_normal_deg"], np.nan),
            color=colour,
            label=LABELS[name],
            linewidth=1.3,
        )
    middle = cases["motors"].compression
    axes.axvline((middle["t_mono_ns"][-1] - middle["t_mono_ns"][0]) * 1e-9, color="#808080", linestyle=":")
    axes.set(xlabel="time, s", ylabel="force off the wall's normal, °", ylim=(-4, 100))
    axes.set_title("Pressed until the dotted line, then let go (twin)", fontsize=10)
    axes.legend(loc="upper left")


def _draw_pose(axes: Axes, pose: ReleasePose) -> None:
    for force, colour, label in (
        (pose.motor_n, COLOURS[0], "motor"),
        (pose.brake_n, COLOURS[2], "brake, pressed"),
        (-pose.brake_n, COLOURS[4], "brake, let go"),
        (pose.motor_n + pose.brake_n, COLOURS[6], "sum, pressed"),
        (pose.motor_n - pose.brake_n, COLOURS[1], "sum, let go"),
    ):
        axes.annotate(
            "", xy=(force[0], force[1]), xytext=(0, 0), arrowprops={"arrowstyle": "->", "color": colour}
        )
        axes.plot([], [], color=colour, label=label)
    reach = 1.15 * max(
        FORCE_N, float(np.abs([pose.motor_n, pose.brake_n, pose.motor_n - pose.brake_n]).max())
    )
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="F_x, N", ylabel="F_y, N")
    axes.set_aspect("equal")
    x, y = (1e3 * value for value in pose.point_m)
    axes.set_title(f"({x:.0f}, {y:.0f}) mm: {pose.release_deg:.0f}° off when let go", fontsize=9)
    if pose.point_m[0] == 0.0:
        axes.legend(fontsize=7, loc="upper right")
