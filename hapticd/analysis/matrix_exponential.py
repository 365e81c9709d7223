"""The exponential of a small matrix."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]

SPAN = 0.25
"""Norm to which the matrix is halved before the series."""

TERMS = 12
"""Of the series: 0.25¹³/13! is below rounding."""


def exponential(matrix: Matrix) -> Matrix:
    """e^A of a square matrix by scaling and squaring."""
    halvings = max(0, math.ceil(math.log2(max(float(np.linalg.norm(matrix, 1)), SPAN) / SPAN)))
    scaled = matrix / 2**halvings
    total = term = np.eye(len(matrix))
    for order in range(1, TERMS + 1):
        term = term @ scaled / order
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total
