"""The stiffest walls that settle, over damping: simulated once for a model, a rate and a delay."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hapticd.analysis.bisection import largest
from hapticd.analysis.device_loop import DeviceLoop, device_loop
from hapticd.analysis.settling import RIGID, bound_m, push
from hapticd.model import Model

DAMPING_SHARES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8)
"""Dampings looked at, of the largest that is linearly stable without a spring."""

LADDER = 1.25
"""Ratio of one stiffness to the next on the way up to the first that does not settle."""

ACCURACY = 0.02
"""To which the first that does not settle is then told from the last that does, relative."""

LOWEST_SHARE = 0.25
HIGHEST_SHARE = 50.0
"""Where the way up begins and ends, of the coupling's own stiffness."""

DELAY_SLACK = 0.1
"""Of a tick: what a delay may exceed whole ticks by without being simulated as one more."""

SUBSTEP_MAX_S = 5e-5

STIFFEST_N_PER_M = 1e6
"""Past anything a spring drive gives."""


class Abandoned(Exception):
    """Nobody waits for the simulation any more."""


@dataclass(frozen=True, slots=True)
class SettlingTable:
    """Largest simulated-stable stiffness, N/m, at each damping, N·s/m. Between them it is interpolated.

    ``bound_m`` says what counted as rest.
    """

    damping_n_s_per_m: tuple[float, ...]
    stiffness_n_per_m: tuple[float, ...]
    bound_m: float

    def largest_stiffness_n_per_m(self, damping_n_s_per_m: float) -> float:
        """Largest stiffness that settled with this damping, N/m; 0 past the dampings looked at."""
        return float(np.interp(damping_n_s_per_m, self.damping_n_s_per_m, self.stiffness_n_per_m, right=0.0))


def delay_ticks(rate_hz: float, delay_s: float) -> int:
    """Ticks of delay that the twin is given beyond the one every exchange takes."""
    return max(0, math.ceil(delay_s * rate_hz - 1.0 - DELAY_SLACK))


def settling_table(
    model: Model, rate_hz: float, ticks: int, wanted: Callable[[], bool] = lambda: True
) -> SettlingTable:
    """Simulates the table; seconds of work. ``wanted`` is asked between runs: ``Abandoned`` once it is not.

    ``ValueError``: the model has no twin, or its twin cannot run at this rate.
    """
    if json.loads(model.twin_json) is None:
        raise ValueError(f"{model.name} has no [twin] to simulate.")
    loop = device_loop(model, rate_hz, (1 + ticks) / rate_hz)
    late, rest_m = delayed(model, rate_hz, ticks), bound_m(loop)

    def settles(stiffness: float, damping: float) -> bool:
        if not wanted():
            raise Abandoned
        wall = drive_values(model, loop, stiffness, damping)
        return push(late.changed(wall), rate_hz, law=wall_law(loop, damping)).settled(rest_m)

    limit = loop.linear.largest_damping_n_s_per_m()
    dampings = tuple(share * limit for share in DAMPING_SHARES)
    found = tuple(_first_unsettled(loop, damping, settles) for damping in dampings)
    return SettlingTable(dampings, found, rest_m)


def _first_unsettled(loop: DeviceLoop, damping: float, settles: Callable[[float, float], bool]) -> float:
    """Up in steps until one does not settle: settling need not be monotonic, what lies below must."""

    def holds(stiffness: float) -> bool:
        return settles(stiffness, damping)

    stiffness = LOWEST_SHARE * loop.coupling.stiffness_n_per_m
    highest = HIGHEST_SHARE * loop.coupling.stiffness_n_per_m
    if not holds(stiffness):
        return 0.0
    while stiffness < highest and holds(stiffness * LADDER):
        stiffness *= LADDER
    return largest(holds, stiffness, stiffness * LADDER, ACCURACY)


def drive_values(model: Model, loop: DeviceLoop, stiffness: float, damping: float) -> dict[str, Any]:
    """Overrides of the model that make a rigid wall this stiff, N/m, and damped, N·s/m.

    A spring drive is tuned: every K_P by the same factor, from k_c as it is to k_c as it shall be.
    """
    if not loop.coupling.is_spring_drive:
        return {"drive.stiffness_n_per_m": stiffness, "drive.damping_n_s_per_m": damping}
    factor = stiffness / loop.coupling.stiffness_n_per_m
    k_p = json.loads(model.device_json)["drive"]["k_p_v_per_rad"]
    return {"drive.k_p_v_per_rad": [factor * value for value in k_p]}


def wall_law(loop: DeviceLoop, damping: float) -> Mapping[str, Any]:
    """The law of the wall beside ``drive_values``: on a spring drive damping is the wall's own.

    Its spring is granted as k_c, whatever more is asked for.
    """
    if not loop.coupling.is_spring_drive or damping == 0.0:
        return RIGID
    return {"type": "spring", "stiffness_n_per_m": STIFFEST_N_PER_M, "damping_n_s_per_m": damping}


def delayed(model: Model, rate_hz: float, ticks: int) -> Model:
    """The model with this delay beyond one tick, and substeps short enough for its rate."""
    own: int = json.loads(model.twin_json)["substeps"]
    substeps = max(own, math.ceil(1.0 / (rate_hz * SUBSTEP_MAX_S)))
    return model.changed({"twin.command_delay_ticks": ticks, "twin.substeps": substeps})
