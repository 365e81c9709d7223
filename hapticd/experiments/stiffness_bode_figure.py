"""The picture of the stiffness over frequency: magnitude and phase."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.figure_file import COLOURS
from hapticd.experiments.stiffness_curve import Curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {
    "motor": "unmodified motor",
    "spring_drive": "spring drive",
    "p": "spring drive with P",
    "pd": "spring drive with PD",
    "p_servo": "with P at the servo's rate",
}

STYLES = {"motor": ":", "spring_drive": "--", "p": "-", "pd": "-.", "p_servo": "-"}


def draw(figure: Figure, curves: Sequence[Curve], drive: SpringDrive) -> None:
    """Lines are closed forms, marks are what the twin's encoder and current tell."""
    magnitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    softest = min(np.abs(curve.stiffness).min() for curve in curves)
    magnitude.set(xscale="log", yscale="log", ylim=(0.5 * softest, 3.0 * drive.k_hf))
    span = [curve.frequency_hz for curve in curves]
    low, high = min(f.min() for f in span), max(f.max() for f in span)
    for curve, colour in zip(curves, COLOURS, strict=False):
        _draw_curve(magnitude, phase, curve, colour, (low, high))
    _mark(magnitude, curves, drive, high)
    magnitude.set(ylabel="stiffness at the rotor |K_θ|, N·m/rad")
    phase.set(xlabel="frequency, Hz", ylabel="phase, °", ylim=(-105, 105), yticks=range(-90, 91, 45))
    magnitude.set_title(
        "Lines: WN eq. 12, at the servo's rate with its hold and delay. Marks: twin", fontsize=9.5
    )
    magnitude.legend(loc="lower right")


def _draw_curve(magnitude: Axes, phase: Axes, curve: Curve, colour: str, span: tuple[float, float]) -> None:
    sampled = curve.name == "p_servo"
    dense = np.geomspace(span[0], 0.5 * curve.rate_hz if sampled else span[1], 600)
    period_s = 1.0 / curve.rate_hz
    form = (
        curve.drive.sampled(dense, period_s, curve.delay_ticks) if sampled else curve.drive.stiffness(dense)
    )
    face = "none" if sampled else colour
    label = f"{LABELS[curve.name]}, {curve.rate_hz:g} Hz" if sampled else LABELS[curve.name]
    for axes, value in ((magnitude, np.abs), (phase, _degrees)):
        axes.plot(dense, value(form), STYLES[curve.name], color=colour, linewidth=1.3, label=label)
        axes.plot(
            curve.frequency_hz, value(curve.stiffness), "o", color=colour, markerfacecolor=face, markersize=4
        )


def _mark(axes: Axes, curves: Sequence[Curve], drive: SpringDrive, high: float) -> None:
    low = min(curve.frequency_hz.min() for curve in curves)
    for value, name, at, side in ((drive.k_dc, "K_DC", low, "left"), (drive.k_hf, "K_HF", high, "right")):
        axes.axhline(value, color="#808080", linewidth=0.8, zorder=0)
        up = 1.15 if side == "left" else 1.35
        axes.text(at, up * value, f"{name} = {value:.2f}", ha=side, va="bottom", color="#505050")
    for curve in curves[:2]:
        corner = curve.drive.corner_hz
        axes.axvline(corner, color="#808080", linewidth=0.8, linestyle=":", zorder=0)
        name = "R/L" if curve.name == "motor" else "dR/L"
        axes.text(corner, 0.02 * drive.k_hf, f" {name}", va="bottom", color="#505050")


def _degrees(value: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.asarray(np.angle(value, deg=True), dtype=np.float64)
