"""The picture of a stability map: what settled, what cycled, what did not, and the lines of theory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.stability_lines import Lines
from hapticd.experiments.stability_survey import Survey, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIELDS = ("#D9EAF7", "#F6D28B", "#C9B8B0")
"""Settled, limit cycle, unstable: light to dark, so that they differ in grey as well."""

NAMES = ("comes to rest", "limit cycle in the wall", "leaves the wall")


def draw(figure: Figure, survey: Survey, found: Lines, trial: Trial) -> None:
    """The map with the passive and the linear limit."""
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    sheet = survey.sheet
    axes = figure.subplots()
    norm = BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3)
    axes.pcolormesh(
        sheet.across, sheet.up, survey.outcome, cmap=ListedColormap(FIELDS), norm=norm, shading="nearest"
    )
    for line, colour, style, name in (
        (found.linear, COLOURS[0], "-", "linear limit, no hand, no dry friction"),
        (found.passive, COLOURS[1], "o--", "passive limit, sampling and delay"),
    ):
        shown = np.where((line >= sheet.up[0]) & (line <= sheet.up[-1]), line, np.nan)
        label = name if np.isfinite(shown).any() else f"{name}: off the map"
        axes.plot(sheet.across, shown, style, color=colour, linewidth=1.8, markersize=3.5, label=label)
    axes.set_yscale("log")
    axes.set(xlabel=sheet.across_label, ylabel=sheet.up_label, ylim=(sheet.up[0], sheet.up[-1]))
    watched = ", watched by passivity" if trial.passivity else ""
    axes.set_title(f"A wall under a push at {trial.rate_hz:g} Hz{watched}", fontsize=10)
    handles = [Patch(color=colour, label=name) for colour, name in zip(FIELDS, NAMES, strict=True)]
    axes.legend(handles=[*handles, *axes.get_legend_handles_labels()[0]], loc="lower right", fontsize=8.5)
    axes.grid(False)
