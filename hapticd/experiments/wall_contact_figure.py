"""The picture of KS Figs. 8 and 9: position, force and speed over time, and force over position."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.wall_contact_strike import STRENGTHS, WALLS, Strike

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SPAN_S = {"weak": 0.5, "strong": 0.8}
LABELS = {
    "active": "active: spring",
    "popc": "PO/PC as published",
    "passivity": "passivity control of hapticd",
    "hybrid": "hybrid: damper, brake",
}


def draw(figure: Figure, strikes: Mapping[tuple[str, str], Strike]) -> None:
    """Weak contact on the left of each pair, strong on the right; one row per wall."""
    figure.set_size_inches(12.5, 10.0)
    grid = figure.subplots(len(WALLS), 2 * len(STRENGTHS))
    for row, wall in enumerate(WALLS):
        for pair, strength in enumerate(STRENGTHS):
            strike = strikes[strength, wall]
            over_time, over_depth = grid[row][2 * pair], grid[row][2 * pair + 1]
            _draw_time(over_time, strike, SPAN_S[strength])
            _draw_loop(over_depth, strike)
            over_time.set_title(f"{strength}, {LABELS[wall]}", fontsize=8.5)


def _draw_time(axes: Axes, strike: Strike, span_s: float) -> None:
    trace = strike.trace()
    axes.plot(trace["t_s"], 1e3 * trace["depth_m"], color=COLOURS[0], label="depth, mm", linewidth=1.1)
    axes.axhline(0.0, color="#808080", linewidth=0.8)
    deepest = 1e3 * float(trace["depth_m"][strike.watched].max())
    axes.set(xlim=(-0.02, span_s), ylim=(-max(1.0, 0.6 * deepest), 1.25 * max(1.0, deepest)))
    axes.set_xlabel("time from contact, s", fontsize=8)
    axes.set_ylabel("depth, mm", color=COLOURS[0], fontsize=8)
    force = axes.twinx()
    force.plot(trace["t_s"], trace["force_n"], color=COLOURS[1], linewidth=0.8)
    force.set_ylabel("force, N", color=COLOURS[1], fontsize=8)
    force.grid(visible=False)


def _draw_loop(axes: Axes, strike: Strike) -> None:
    trace = strike.trace()
    axes.plot(1e3 * trace["depth_m"], trace["force_n"], color=COLOURS[2], linewidth=0.7)
    deepest = 1e3 * float(trace["depth_m"][strike.watched].max())
    axes.set(xlim=(-max(1.0, 0.6 * deepest), 1.25 * max(1.0, deepest)))
    axes.set_xlabel("depth, mm", fontsize=8)
    axes.set_ylabel("force, N", fontsize=8)
