"""Winding temperature of a motor (physics §1.1)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Motor:
    """Two thermal masses: winding on case on ambient."""

    ambient_c: float
    winding_case_k_per_w: float
    case_ambient_k_per_w: float
    winding_s: float
    case_s: float

    def temperatures_c(self, loss_w: float, time_s: float) -> Vector:
        """Winding and case after `time_s` of constant loss from ambient, by the exact solution of
        C dT/dt = loss - flows, with heat capacities from the time constants of the data sheet."""
        winding_capacity = self.winding_s / self.winding_case_k_per_w
        case_capacity = self.case_s / self.case_ambient_k_per_w
        to_case, to_ambient = 1 / self.winding_case_k_per_w, 1 / self.case_ambient_k_per_w
        a = np.array(
            [
                [-to_case / winding_capacity, to_case / winding_capacity],
                [to_case / case_capacity, -(to_case + to_ambient) / case_capacity],
            ]
        )
        steady = np.linalg.solve(a, [-loss_w / winding_capacity, 0.0])
        values, vectors = np.linalg.eig(a)
        weights = np.linalg.solve(vectors, -steady)
        rise: Vector = steady + vectors @ (np.exp(values * time_s) * weights)
        return self.ambient_c + rise


def resistance_ohm(r_25_ohm: float, winding_c: float) -> float:
    """R(T) = R25 (1 + 0.00393 ΔT)."""
    return r_25_ohm * (1 + 0.00393 * (winding_c - 25))


def i2t_used(load: float, continuous: float, peak: float, peak_time_s: float, time_s: float) -> float:
    """Share of the I²t budget after `time_s` of constant load from cold, so that `peak` uses all of
    it in `peak_time_s` and `continuous` in infinite time."""
    reaches_one = 1 - (continuous / peak) ** 2
    decay: float = reaches_one ** (time_s / peak_time_s)
    return (load / continuous) ** 2 * (1 - decay)
