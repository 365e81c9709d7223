"""The part of a signal at one frequency, by least squares."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def phasor(
    time_s: NDArray[np.float64], signal: NDArray[np.float64], frequency_hz: float
) -> NDArray[np.complex128]:
    """Complex amplitude c of ``signal`` ≈ Re(c e^(jωt)) + offset + drift·t. Signal (n,) or (n, axes)."""
    angle = 2 * np.pi * frequency_hz * time_s
    basis = np.column_stack([np.cos(angle), np.sin(angle), np.ones_like(angle), time_s - time_s.mean()])
    fitted = np.linalg.lstsq(basis, signal, rcond=None)[0]
    found: NDArray[np.complex128] = np.asarray(fitted[0] - 1j * fitted[1])
    return found
