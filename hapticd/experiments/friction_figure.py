"""The picture of KS Figs. 11 and 12: force and displacement over time; beside it the rule as printed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.friction_drag import STRENGTHS, SYSTEMS, Drag
from hapticd.experiments.friction_rule import LET_GO_S, Coast

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {"active": "active: friction by motors", "hybrid": "hybrid: friction by brakes"}


def draw(figure: Figure, drags: Mapping[tuple[str, str], Drag], coasts: Mapping[str, Coast]) -> None:
    """One row per normal force, one column per system; on the right the rules when the hand lets go."""
    figure.set_size_inches(12.5, 7.0)
    grid = figure.subplots(len(STRENGTHS), len(SYSTEMS) + 1)
    for row, strength in enumerate(STRENGTHS):
        for column, system in enumerate(SYSTEMS):
            drag = drags[strength, system]
            _draw_drag(grid[row][column], drag)
            newtons = drag.numbers()["normal_n"] or 0.0
            grid[row][column].set_title(f"{strength}, {newtons:.0f} N, {LABELS[system]}", fontsize=9)
    _draw_rules(grid[0][-1], grid[1][-1], coasts)
    grid[0][0].legend(fontsize=8, loc="upper left")


def _draw_drag(axes: Axes, drag: Drag) -> None:
    time_s = drag.time_s
    axes.plot(time_s, drag.pull_n, color=COLOURS[0], linewidth=1.0, label="pull, measured")
    axes.plot(time_s, drag.computed_n, color=COLOURS[1], linewidth=1.0, label="friction, asked for")
    top = 1.4 * float(drag.pull_n.max())
    axes.set(xlabel="time, s", ylabel="force along the wall, N", ylim=(-0.3 * top, top))
    way = axes.twinx()
    way.plot(time_s, 1e3 * (drag.x_m - drag.x_m[0]), color=COLOURS[2], linewidth=1.2, linestyle="--")
    way.set_ylabel("displacement, mm", color=COLOURS[2])
    way.grid(visible=False)


def _draw_rules(above: Axes, below: Axes, coasts: Mapping[str, Coast]) -> None:
    for number, (rule, coast) in enumerate(coasts.items()):
        colour = COLOURS[number]
        above.plot(coast.time_s, 1e3 * coast.x_m, color=colour, label=f"rule {rule}", linewidth=1.2)
        below.plot(coast.time_s, coast.force_n, color=colour, label=f"rule {rule}", linewidth=1.0)
    above.set(xlabel="time, s", ylabel="displacement, mm")
    below.set(xlabel="time, s", ylabel="friction by the motors, N")
    above.set_title("the hand lets go of a moving tip, still pressed on", fontsize=9)
    for axes in (above, below):
        axes.axvline(LET_GO_S, color="#808080", linewidth=0.8)
        axes.legend(fontsize=8)
