"""The passivity observer's energy, by integrating the torque finely instead of in closed form."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
SUBSTEPS = 2000


@dataclass
class Lag:
    """A first-order torque lag, and the energy it takes from joints that move evenly in each period."""

    lag_s: Vector
    period_s: float
    torque_nm: Vector = field(default_factory=lambda: np.zeros(3))
    energy_j: float = 0.0

    def live(self, command_nm: Vector, step_rad: Vector) -> None:
        """One period under a held command: E −= ∫ τ q̇ dt."""
        times_s = (np.arange(SUBSTEPS) + 0.5) * self.period_s / SUBSTEPS
        kept = np.exp(-times_s[:, None] / self.lag_s)
        torques_nm = command_nm + kept * (self.torque_nm - command_nm)
        self.energy_j -= float(np.mean(torques_nm, axis=0) @ step_rad)
        self.torque_nm = command_nm + np.exp(-self.period_s / self.lag_s) * (self.torque_nm - command_nm)
