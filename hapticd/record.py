"""Tick records as numpy sees them."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from hapticd import _core


@cache
def record_dtype() -> np.dtype[Any]:
    """Structured type of one tick record: ``f8`` and ``u8``, shape () or (3,), in the core's order."""
    return np.dtype(
        [
            (field["name"], "<f8" if field["kind"] == "float" else "<u8", () if field["words"] == 1 else (3,))
            for field in _core.tick_schema()
        ]
    )
