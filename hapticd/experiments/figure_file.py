"""A figure as PNG and SVG, the same bytes every time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hapticd.experiments.experiment import Outcome
from hapticd.experiments.library import require

SIZE_IN = (9.0, 5.5)
DPI = 140

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito: told apart also by those who see fewer colours, and in print."""


def write_figure(outcome: Outcome, stem: Path) -> list[Path]:
    """Draws ``stem``.png and ``stem``.svg. ``Problem`` (library-missing)."""
    matplotlib = require("matplotlib")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(_style(matplotlib.rcParamsDefault, stem.name)):
        figure = Figure(figsize=SIZE_IN, dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        outcome.figure(figure)
        png, svg = (stem.with_name(f"{stem.name}.{kind}") for kind in ("png", "svg"))
        figure.savefig(png, metadata={"Software": None})
        figure.savefig(svg, metadata={"Date": None, "Creator": None})
    return [png, svg]


def _style(defaults: Mapping[str, Any], salt: str) -> dict[str, Any]:
    """The defaults of matplotlib, whatever is set on this machine, with the style of all figures."""
    from cycler import cycler

    settings = {name: value for name, value in defaults.items() if not name.startswith("backend")}
    return {
        **settings,
        "svg.hashsalt": salt,
        "axes.prop_cycle": cycler(color=COLOURS),
        "axes.grid": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "grid.color": "#D8D8D8",
        "grid.linewidth": 0.6,
        "legend.framealpha": 0.9,
        "font.size": 9.5,
    }
