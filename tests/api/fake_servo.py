"""A servo without a loop: the front's link to it, answering at once and ticking with the clock."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from hapticd.record import record_dtype

STATES = ("offline", "disabled", "enabled", "paused", "fault")
ESTOP_FLAG = 1 << 2
NO_WALL = 2**64 - 1
ESTOP_INTERLOCK = "estop-latched"


class FakeServo:
    """Implements `hapticd.channel.Link` for one device."""

    def __init__(self, device_id: str, *, rate_hz: float = 1000.0) -> None:
        self._device_id = device_id
        self._rate_hz = rate_hz
        self._begun = time.monotonic()
        self._acks: list[dict[str, Any]] = []
        self.requests: list[dict[str, Any]] = []
        self.state = "disabled"
        self.faults = 0
        self.estop = False
        self.revision = 0
        self.force_is_nan = False
        self.mute = False
        self.on_scene: Callable[[], None] = lambda: None

    def info(self) -> dict[str, Any]:
        return {
            "device_id": self._device_id,
            "rate_hz": self._rate_hz,
            "pid": 4711,
            "started_utc_ns": 0,
            "started_mono_ns": 0,
            "boot_id": "test",
            "is_twin": True,
            "layout_version": 1,
            "schema_hash": 0,
            "tick_capacity": 4096,
        }

    def heartbeat(self) -> None:
        return None

    def servo_alive(self) -> bool:
        return True

    def close(self) -> None:
        return None

    def events(self) -> list[Any]:
        return []

    def head(self) -> int:
        return 10 + int((time.monotonic() - self._begun) * self._rate_hz)

    def send(self, request_json: str, /) -> int:
        request = json.loads(request_json)
        self.requests.append(request)
        request_id = len(self.requests)
        if not self.mute:
            result = self._apply(request)
            self._acks.append(
                {
                    "id": request_id,
                    "tick": self.head(),
                    "t_mono_ns": time.monotonic_ns(),
                    "result": result,
                    "interlocks": self._interlocks(),
                    "state": self.state,
                }
            )
        return request_id

    def acks(self) -> list[dict[str, Any]]:
        taken, self._acks = self._acks, []
        return taken

    def read(self, since: int, max_ticks: int, /) -> tuple[bytes, int, int]:
        first = max(since, self.head() - 4000)
        count = max(0, min(self.head() - first, max_ticks))
        return self._records(first, count).tobytes(), first, first - since

    def latest(self) -> bytes:
        return self._records(self.head() - 1, 1).tobytes()

    def status(self) -> dict[str, Any]:
        histogram = {
            "count": 3,
            "sum_ns": 6000,
            "max_ns": 3000,
            "p50_ns": 2000,
            "p99_ns": 3000,
            "p999_ns": 3000,
            "edges_ns": [0, 1000, 2000, 4000],
            "counts": [0, 1, 2],
        }
        return {
            "tick": self.head() - 1,
            "t_mono_ns": time.monotonic_ns(),
            "state": self.state,
            "interlocks": self._interlocks(),
            "phase": "running",
            "missed_ticks": 2,
            "requests_applied": len(self.requests),
            "identity": "fake",
            "scheduling": {
                "realtime": "preferred",
                "realtime_ok": False,
                "policy": "other",
                "priority": 0,
                "cpu": None,
                "memory_locked": False,
                "problems": ["No right to SCHED_FIFO."],
                "selftest_samples": 100,
                "selftest_median_ns": 60_000,
                "selftest_p99_ns": 90_000,
                "selftest_max_ns": 120_000,
            },
            "lateness": histogram,
            "exchange": histogram,
            "compute": histogram,
        }

    def _apply(self, request: dict[str, Any]) -> str:
        match request["type"]:
            case "desired" if request["desired"] == "enabled" and self._interlocks():
                return "refused"
            case "desired":
                self.state = request["desired"]
            case "estop":
                self.estop, self.state = True, "disabled"
            case "estop_ack":
                self.estop = False
            case "fault_ack":
                self.faults &= ~request["faults"]
                self.state = "disabled"
            case "scene":
                self.revision = request["scene"]["revision"]
                self.on_scene()
        return "applied"

    def _interlocks(self) -> int:
        from hapticd import _core

        slugs = [entry["slug"] for entry in _core.interlock_table()]
        return 1 << slugs.index(ESTOP_INTERLOCK) if self.estop else 0

    def _records(self, first: int, count: int) -> np.ndarray[Any, np.dtype[np.void]]:
        records = np.zeros(count, record_dtype())
        records["tick"] = np.arange(first, first + count)
        records["t_mono_ns"] = records["tick"] * 1_000_000
        records["state"] = STATES.index(self.state)
        records["flags"] = ESTOP_FLAG if self.estop else 0
        records["faults"] = self.faults
        records["scene_revision"] = self.revision
        records["contact_wall"] = NO_WALL
        records["tip_position_m"] = (0.197, 0.0, 0.023)
        records["stiffness_n_per_m"] = 1500.0
        if self.force_is_nan:
            records["tip_force_n"] = np.nan
        return records
