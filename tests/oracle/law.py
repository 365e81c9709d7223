"""How walls answer penetration (WN eq. 17, 30; KS §4; physics §6), restated without the core's shortcuts."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
ROOT_SAMPLES = 200_001


def spring(law: Mapping[str, Any], rigid: tuple[float, float]) -> tuple[float, float]:
    """K and B of a wall's spring, where a rigid wall has ``rigid``."""
    if law["type"] == "motion":
        return (1 - law["eta"]) * rigid[0], (1 - law["eta"]) * rigid[1]
    if law["type"] == "spring":
        return law["stiffness_n_per_m"], law["damping_n_s_per_m"]
    return 0.0, 0.0


def penetration_let_pass(law: Mapping[str, Any], rigid_n_per_m: float, reference_n_per_m: float) -> float:
    """η: the depth that is left beside a spring of the reference stiffness that would hold all of it."""
    return min(1.0, max(0.0, 1 - spring(law, (rigid_n_per_m, 0.0))[0] / reference_n_per_m))


def damper_force(law: Mapping[str, Any], v: float, hardest: float, limit: float) -> float:
    """Force of a wall without spring at the closing speed ``v``; no damper is harder than ``hardest``."""
    if v <= 0 or law["type"] in ("motion", "spring"):
        return 0.0
    if law["type"] == "damper":
        return float(min(law["damping_n_s_per_m"] * v, limit))
    c = law["coefficient_n_s3_per_m3"]
    speed = v if law["form"] == "explicit" else speed_left(c, v, hardest)
    return float(min(c * speed**3, limit))


def speed_left(c: float, v: float, hardest: float) -> float:
    """w in 0…v with C w³ = B (v − w), by trying."""
    low, high = 0.0, v
    for _ in range(4):
        w = np.linspace(low, high, ROOT_SAMPLES)
        above = int(np.argmax(c * w**3 - hardest * (v - w) >= 0))
        low, high = float(w[max(above - 1, 0)]), float(w[above])
    return high


def hardest_damper(mass: float, period_s: float, lag_s: float, lam: float) -> float:
    """Damping with which the open loop, two ticks late, crosses −180° at unit gain, by trying ω."""
    w = np.geomspace(1.0, 2e4, ROOT_SAMPLES)
    per_damping = np.exp(-2j * w * period_s) / (1j * w * mass * (1 + 1j * w * lag_s) * (1 + 1j * w / lam))
    phase = np.unwrap(np.angle(per_damping))
    crossing = int(np.argmax(phase <= -np.pi))
    return float(1 / abs(per_damping[crossing]))
