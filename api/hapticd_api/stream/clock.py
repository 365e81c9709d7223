"""The two clocks at one instant, so that a client can place device times in its own."""

from __future__ import annotations

import time
from datetime import UTC, datetime
from typing import Any


def clock_map() -> dict[str, Any]:
    """`t_mono_ns` (the clock of ticks) and `t_utc` (RFC 3339) of now."""
    return {"t_mono_ns": time.monotonic_ns(), "t_utc": datetime.now(UTC).isoformat()}
