"""The picture of a device's stiffness over frequency: magnitude and phase at the locked tip."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.bode_on_device import DELAY_TICKS, BodeOnDevice
from hapticd.experiments.figure_file import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Vector = NDArray[np.float64]

LABELS = {
    "currents": "by motor currents",
    "estimate": "by the model of the motors",
    "sensor": "by the sensor",
}
MARKS = {"currents": "o", "estimate": "s", "sensor": "^"}

LOWEST = 0.2
"""Share of k_c below which nothing is drawn: a sensor behind friction sees next to nothing."""


def draw_on_device(figure: Figure, found: BodeOnDevice) -> None:
    """Lines are closed forms, marks are what the device's instruments tell."""
    magnitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    dense = np.geomspace(found.motors.frequency_hz[0], found.motors.frequency_hz[-1], 600)
    continuous = found.form.continuous(dense)
    for axes, line in ((magnitude, np.abs(continuous)), (phase, np.degrees(np.angle(continuous)))):
        axes.plot(dense, line, ":", color="#606060", label="closed form without ticks")
    for name, colour in zip(found.series, COLOURS, strict=False):
        _draw_series(magnitude, phase, found, name, dense, colour)
    magnitude.axhline(found.k_c, color="#808080", linewidth=0.8, zorder=0)
    name = f"k_c = {found.k_c:.0f} N/m"
    magnitude.text(dense[-1], 0.97 * found.k_c, name, ha="right", va="top", color="#505050")
    drawn = np.concatenate([np.abs(series.stiffness) for series in found.series.values()])
    low, high = max(0.75 * drawn.min(), LOWEST * found.k_c), 2.5 * drawn.max()
    magnitude.set(xscale="log", yscale="log", ylabel="stiffness at the tip, N/m", ylim=(low, high))
    magnitude.set_title(
        f"Lines: closed form, solid with hold and delay at {found.rate_hz:g} Hz. Marks: device", fontsize=9.5
    )
    magnitude.legend(loc="upper left")
    phase.set(xlabel="frequency, Hz", ylabel="phase, °", yticks=range(-450, 181, 90), ylim=_ends(phase))


def _draw_series(
    magnitude: Axes, phase: Axes, found: BodeOnDevice, name: str, dense: Vector, colour: str
) -> None:
    series = found.series[name]
    sampled = found.form.sampled(dense, 1.0 / found.rate_hz, DELAY_TICKS[name])
    expected_deg = np.degrees(np.unwrap(np.angle(sampled)))
    phase_deg = np.interp(series.frequency_hz, dense, expected_deg) + np.degrees(
        np.angle(series.stiffness / series.expected)
    )
    if series is found.motors:
        magnitude.plot(dense, np.abs(sampled), "-", color=colour, linewidth=1.3)
    phase.plot(dense, expected_deg, "-", color=colour, linewidth=1.3)
    face = colour if series is found.motors else "none"
    for axes, marks in ((magnitude, np.abs(series.stiffness)), (phase, phase_deg)):
        axes.plot(
            series.frequency_hz,
            marks,
            MARKS[name],
            color=colour,
            markersize=5,
            markerfacecolor=face,
            label=LABELS[name],
        )


def _ends(phase: Axes) -> tuple[float, float]:
    """What is drawn, with a margin, °."""
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=np.float64) for line in phase.lines])
    return float(drawn.min()) - 15.0, float(drawn.max()) + 15.0
