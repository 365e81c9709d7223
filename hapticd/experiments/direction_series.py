"""Where the force points for walls all around a tip that is held: one mapping."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]

HALF_TURNS = 2
"""An ellipse looks the same after half a turn: its error has two periods a turn."""


@dataclass(frozen=True)
class Series:
    """Wall normals (n,) rad, forces on the sensor in the plane (n, 2) N, and the error expected."""

    angle_rad: Vector
    force_n: Matrix
    closed_form: Callable[[Vector], Vector]

    @property
    def expected_rad(self) -> Vector:
        """The closed form at the walls, (n,)."""
        return self.closed_form(self.angle_rad)

    @property
    def error_rad(self) -> Vector:
        """Angle from the wall normal to the force, counter-clockwise, (n,)."""
        cos, sin = np.cos(self.angle_rad), np.sin(self.angle_rad)
        x, y = self.force_n.T
        found: Vector = np.arctan2(cos * y - sin * x, cos * x + sin * y)
        return found

    @property
    def max_abs_error_deg(self) -> float:
        """Largest error, °."""
        return float(np.degrees(np.abs(self.error_rad).max()))

    @property
    def rms_error_deg(self) -> float:
        """Root mean square of the error, °."""
        return float(np.degrees(np.sqrt(np.mean(self.error_rad**2))))

    @property
    def max_off_expected_deg(self) -> float:
        """Largest distance from the closed form, °."""
        return float(np.degrees(np.abs(self.error_rad - self.expected_rad).max()))

    @property
    def periodic_share(self) -> float:
        """Share of the error's variance with the period of an ellipse: its first four harmonics."""
        harmonics = HALF_TURNS * np.arange(1, 5)
        turns = self.angle_rad[:, None] * harmonics
        basis = np.column_stack([np.ones_like(self.angle_rad), np.cos(turns), np.sin(turns)])
        fitted = basis @ np.linalg.lstsq(basis, self.error_rad, rcond=None)[0]
        around = self.error_rad - self.error_rad.mean()
        return float(1.0 - np.sum((self.error_rad - fitted) ** 2) / max(np.sum(around**2), 1e-300))

    def has(self, angle_deg: float) -> bool:
        """Whether there is a wall with this normal."""
        apart = np.angle(np.exp(1j * (self.angle_rad - np.radians(angle_deg))))
        return bool(np.abs(apart).min() < 1e-6)

    def at(self, angle_deg: float) -> float:
        """Error for the wall whose normal is nearest to an angle, °."""
        apart = np.angle(np.exp(1j * (self.angle_rad - np.radians(angle_deg))))
        return float(np.degrees(self.error_rad[np.argmin(np.abs(apart))]))

    def numbers(self) -> dict[str, Any]:
        """The series as JSON."""
        return {
            "max_abs_error_deg": self.max_abs_error_deg,
            "rms_error_deg": self.rms_error_deg,
            "max_off_closed_form_deg": self.max_off_expected_deg,
            "periodic_share": self.periodic_share,
            "wall_deg": np.degrees(self.angle_rad).round(6).tolist(),
            "error_deg": np.degrees(self.error_rad).tolist(),
            "closed_form_deg": np.degrees(self.expected_rad).tolist(),
            "force_n": np.linalg.norm(self.force_n, axis=1).tolist(),
        }

    def trace(self) -> dict[str, Vector]:
        """The series as a table."""
        return {
            "wall_rad": self.angle_rad,
            "error_rad": self.error_rad,
            "closed_form_rad": self.expected_rad,
            "force_along_n": np.sum(self.force_n * _unit(self.angle_rad), axis=1),
            "force_across_n": np.sum(self.force_n * _unit(self.angle_rad + np.pi / 2), axis=1),
        }


def wall_angles(spacing_deg: float) -> Vector:
    """Angles all around, as near to the spacing as whole numbers of walls allow, rad."""
    count = max(1, round(360.0 / spacing_deg))
    found: Vector = np.arange(count) * 2 * np.pi / count
    return found


def _unit(angle_rad: Vector) -> Matrix:
    return np.stack([np.cos(angle_rad), np.sin(angle_rad)], axis=1)
