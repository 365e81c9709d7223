"""The stiffness of a locked tip over frequency, as one of a device's instruments sees it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Spectrum = NDArray[np.complex128]


@dataclass(frozen=True)
class BodeSeries:
    """Measured stiffness, N/m, rising in frequency, beside its closed form; both of shape (n,)."""

    force_from: str
    frequency_hz: Vector
    stiffness: Spectrum
    expected: Spectrum

    @property
    def static_n_per_m(self) -> float:
        """Magnitude at the lowest frequency."""
        return float(np.abs(self.stiffness[0]))

    @property
    def off_db(self) -> float:
        """Largest distance of the magnitude from the closed form, dB."""
        return float(np.max(np.abs(20 * np.log10(np.abs(self.stiffness / self.expected)))))

    @property
    def shape_off_db(self) -> float:
        """The same with both scaled to their static ends, dB."""
        ratio = np.abs(self.stiffness / self.expected)
        return float(np.max(np.abs(20 * np.log10(ratio / ratio[0]))))

    @property
    def phase_off_deg(self) -> float:
        """Largest distance of the phase from the closed form, °."""
        return float(np.max(np.abs(self._lead_rad)) * 180 / np.pi)

    @property
    def later_s(self) -> float:
        """Delay beyond that of the closed form which fits the phases best, s."""
        omega = 2 * np.pi * self.frequency_hz
        return float(-(omega @ self._lead_rad) / (omega @ omega))

    @property
    def _lead_rad(self) -> Vector:
        return np.asarray(np.angle(self.stiffness / self.expected), dtype=np.float64)

    def numbers(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "force_from": self.force_from,
            "frequency_hz": self.frequency_hz.tolist(),
            "magnitude_n_per_m": np.abs(self.stiffness).tolist(),
            "phase_deg": np.degrees(np.angle(self.stiffness)).tolist(),
            "closed_form_n_per_m": np.abs(self.expected).tolist(),
            "closed_form_phase_deg": np.degrees(np.angle(self.expected)).tolist(),
            "max_deviation_db": self.off_db,
            "max_shape_deviation_db": self.shape_off_db,
            "max_phase_deviation_deg": self.phase_off_deg,
            "later_s": self.later_s,
        }

    def trace(self) -> dict[str, Vector]:
        """As a table."""
        return {
            "frequency_hz": self.frequency_hz,
            "stiffness_real_n_per_m": self.stiffness.real,
            "stiffness_imag_n_per_m": self.stiffness.imag,
            "closed_real_n_per_m": self.expected.real,
            "closed_imag_n_per_m": self.expected.imag,
        }
