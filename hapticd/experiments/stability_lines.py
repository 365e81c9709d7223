"""The limits of theory over a stability map, and what the map says of each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.bisection import largest
from hapticd.experiments.stability_survey import SETTLED, Survey

Vector = NDArray[np.float64]

ACCURACY = 0.01


@dataclass(frozen=True)
class Lines:
    """Limits at each column, in the unit of the rows: linear, passive, and the last row that settled.

    ``settled_up`` is the largest row below which every row settled; 0 where not even the first did.
    """

    linear: Vector
    passive: Vector
    settled_up: Vector

    def below(self, survey: Survey, line: Vector) -> tuple[int, int]:
        """How many points below a line settled, and how many there are."""
        inside = survey.sheet.up[:, None] <= line[None, :]
        return int((inside & survey.settled()).sum()), int(inside.sum())


def lines(survey: Survey) -> Lines:
    """The limits of every column of the map."""
    columns = [float(x) for x in survey.sheet.across]
    return Lines(
        linear=np.array([_largest_up(survey, x, _linear) for x in columns]),
        passive=np.array([_largest_up(survey, x, _passive) for x in columns]),
        settled_up=np.array(list(_settled_up(survey))),
    )


def _largest_up(survey: Survey, x: float, limit: Callable[[Survey, float, float], float]) -> float:
    """Largest value of the rows' quantity whose wall is within a limit; stiffness rises with it."""

    def within(up: float) -> bool:
        return survey.sheet.stiffness(x, up) <= limit(survey, x, up)

    low, high = survey.sheet.up[0] * 1e-3, survey.sheet.up[-1] * 10
    return largest(within, float(low), float(high), ACCURACY)


def _linear(survey: Survey, x: float, up: float) -> float:
    loop = survey.sheet.loop_at(x, up).linear
    return loop.largest_stiffness_n_per_m(survey.sheet.damping(x, up))


def _passive(survey: Survey, x: float, up: float) -> float:
    loop = survey.sheet.loop_at(x, up)
    sampled = loop.sampled.largest_stiffness_n_per_m(survey.sheet.damping(x, up))
    return min(sampled, loop.coupling.series_n_per_m) if loop.coupling.is_spring_drive else sampled


def _settled_up(survey: Survey) -> Iterator[float]:
    for column in survey.outcome.T:
        bad = np.flatnonzero(column != SETTLED)
        last = len(column) - 1 if len(bad) == 0 else int(bad[0]) - 1
        yield float(survey.sheet.up[last]) if last >= 0 else 0.0
