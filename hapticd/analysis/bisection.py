"""The largest value for which something holds, where it holds below and not above."""

from __future__ import annotations

import math
from collections.abc import Callable


def largest(holds: Callable[[float], bool], low: float, high: float, accuracy: float) -> float:
    """Largest value in ``low``…``high`` that holds, to a relative ``accuracy``; 0 when ``low`` does not.

    Halves the ratio, so that decades cost little. Deterministic; the answer itself was tried and holds.
    """
    if not holds(low):
        return 0.0
    if holds(high):
        return high
    while high > low * (1.0 + accuracy):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
