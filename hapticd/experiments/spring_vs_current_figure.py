"""The picture of both drives: limits over the rate, and one contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from hapticd.experiments.drive_contact import Touch
from hapticd.experiments.drive_limits import Bench, Limits
from hapticd.experiments.figure_file import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CURVES = {
    "spring_passive_n_per_m": ("spring drive, passive", COLOURS[0], "-"),
    "spring_stable_n_per_m": ("spring drive, stable", COLOURS[0], ":"),
    "current_passive_n_per_m": ("current drive, passive", COLOURS[1], "-"),
    "current_stable_n_per_m": ("current drive, stable, best damping", COLOURS[1], ":"),
}

TOUCHES = {
    "spring_drive": ("spring drive (twin)", COLOURS[0]),
    "current_damped": ("current, as stiff, damped", COLOURS[2]),
    "current_bare": ("current, as stiff, bare", COLOURS[1]),
    "current_passive": ("current, passive", COLOURS[3]),
}

SHOWN_S = 0.35
"""Time of the contact that is shown, s."""


def draw(
    figure: Figure, bench: Bench, limits: Sequence[Limits], felt: Mapping[str, Touch], rate_hz: float
) -> None:
    """Left the limits, thin with the longest delay; right depth and force of the contact."""
    grid = figure.add_gridspec(2, 2, width_ratios=(1, 1))
    left = figure.add_subplot(grid[:, 0])
    _draw_limits(left, bench, (limits[0], limits[-1]), rate_hz)
    depth = figure.add_subplot(grid[0, 1])
    _draw_touches(depth, figure.add_subplot(grid[1, 1], sharex=depth), felt)


def _draw_limits(axes: Axes, bench: Bench, limits: Sequence[Limits], rate_hz: float) -> None:
    for one, width in zip(limits, (2.2, 1.0), strict=True):
        for name, (label, colour, style) in CURVES.items():
            column = one.columns[name] / 1e3
            axes.plot(
                one.rate_hz,
                column,
                style,
                color=colour,
                linewidth=width,
                label=None if one.delay_ticks else label,
            )
    axes.axhline(
        bench.series_n_per_m / 1e3, color="#404040", linewidth=1, linestyle="--", label="K_HF, analogue"
    )
    resolution = bench.by_resolution_n_per_m / 1e3
    axes.axhline(resolution, color="#909090", linewidth=1, linestyle="-.", label="2 f_c/Δ, resolution")
    axes.axvline(rate_hz, color="#B0B0B0", linewidth=0.8, zorder=0)
    axes.set(xscale="log", yscale="log", xlabel="rate, Hz", ylabel="largest stiffness at the tip, N/mm")
    axes.set_ylim(top=20 * axes.get_ylim()[1])
    axes.set_title(f"Thick without delay, thin {limits[-1].delay_ticks} ticks late", fontsize=9.5)
    axes.legend(loc="upper left")


def _draw_touches(depth: Axes, force: Axes, felt: Mapping[str, Touch]) -> None:
    for name, (label, colour) in TOUCHES.items():
        contact = felt[name].contact
        begin = contact.time_s[int((contact.depth_m > 0.0).argmax())]
        time_ms = 1e3 * (contact.time_s - begin)
        deepest = f", to {1e3 * contact.depth_m.max():.1f} mm"
        depth.plot(time_ms, 1e3 * contact.depth_m, color=colour, linewidth=1.2, label=label + deepest)
        force.plot(time_ms, contact.force_n, color=colour, linewidth=1.2)
    shallow = max(felt[name].contact.depth_m.max() for name in TOUCHES if name != "current_passive")
    depth.set(ylabel="depth, mm", xlim=(-20, 1e3 * SHOWN_S), ylim=(-800 * shallow, 2600 * shallow))
    depth.set_title("One contact, equal static stiffness but for the passive one", fontsize=9.5)
    force.set(xlabel="time since the touch, ms", ylabel="force of the wall, N")
    depth.legend(loc="upper right", fontsize=8)
