"""The delay from the latch of the encoders to the actuators, as a running servo measures it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from hapticd.model import Model

if TYPE_CHECKING:
    from hapticd._core import ServoStatus


def loop_delay_s(rate_hz: float, exchange_s: float, extra_ticks: int = 0) -> float:
    """One tick, in which the command waits for its exchange, the exchange itself, and ticks known beyond."""
    return (1 + extra_ticks) / rate_hz + exchange_s


def exchange_s(status: ServoStatus | None) -> float:
    """The median exchange, s, from the servo's histogram; 0 before there are any.

    A stability limit is about the delay that every tick has. A rare long exchange is a missed deadline, and
    would otherwise lower the limit of a whole session.
    """
    if status is None or status["exchange"]["count"] == 0:
        return 0.0
    return status["exchange"]["p50_ns"] * 1e-9


def command_delay_ticks(model: Model) -> int:
    """Ticks that the model's twin adds; 0 without a twin."""
    twin = json.loads(model.twin_json)
    return int(twin["command_delay_ticks"]) if twin else 0
