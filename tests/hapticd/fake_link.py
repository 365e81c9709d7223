"""A servo's end of the link, played in memory: requests are answered as the loop would answer them."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from hapticd.reading import FLAGS, STATES
from hapticd.reasons import fault_bits
from hapticd.record import record_dtype

if TYPE_CHECKING:
    from hapticd._core import Ack, ServoEvent, ServoInfo, ServoStatus

ESTOP_LATCHED = 1 << 1
FAULT_LATCHED = 1 << 3
NOT_ENABLED = 1 << 8


class FakeLink:
    """Answers at the next look, unless ``mute`` or, having done it, ``forgetful``.

    A tick passes with each request carried out and with each ``run``.
    """

    def __init__(self, device_id: str = "phantom", pid: int = 4242) -> None:
        self.requests: list[dict[str, Any]] = []
        self.asked = asyncio.Event()
        self.mute = False
        self.forgetful = False
        self.full = False
        self.alive = True
        self.closed = False
        self.beats = 0
        self.told: list[ServoEvent] = []
        self.record = np.zeros((), record_dtype())
        self.record["contact_wall"] = 2**64 - 1
        self.record["stiffness_n_per_m"] = 2000.0
        self.state = "disabled"
        self.estop = False
        self.faults = 0
        self._device_id = device_id
        self._pid = pid
        self._acks: list[Ack] = []
        self._ring: list[bytes] = []
        self._lost_before = 0

    # What the test does ------------------------------------------------------------------------

    def run(self, ticks: int = 1) -> None:
        """Lets ticks pass."""
        for _ in range(ticks):
            self.record["tick"] = len(self._ring)
            self.record["t_mono_ns"] = 1_000_000 * len(self._ring)
            self.record["state"] = STATES.index(self.state)
            self.record["flags"] = self.estop << FLAGS.index("estop")
            self.record["faults"] = self.faults
            self._ring.append(self.record.tobytes())

    def forget(self, before: int) -> None:
        """Overwrites the ring up to a tick."""
        self._lost_before = before

    def raise_fault(self, slug: str) -> None:
        """Latches a fault, as a failed observation would."""
        self.faults |= fault_bits()[slug]
        self.state = "fault"
        self.run()

    # What the front sees -----------------------------------------------------------------------

    def info(self) -> ServoInfo:
        return {
            "device_id": self._device_id,
            "rate_hz": 1000.0,
            "pid": self._pid,
            "started_utc_ns": 0,
            "started_mono_ns": 0,
            "boot_id": "0",
            "is_twin": True,
            "layout_version": 1,
            "schema_hash": 0,
            "tick_capacity": 4096,
        }

    def heartbeat(self) -> None:
        self.beats += 1

    def send(self, request_json: str, /) -> int:
        if self.full:
            raise BlockingIOError
        self.requests.append(json.loads(request_json))
        self.asked.set()
        if not self.mute:
            ack = self._answer(len(self.requests), self.requests[-1])
            self._acks += [] if self.forgetful else [ack]
        return len(self.requests)

    def acks(self) -> list[Ack]:
        answered, self._acks = self._acks, []
        return answered

    def events(self) -> list[ServoEvent]:
        told, self.told = self.told, []
        return told

    def head(self) -> int:
        return len(self._ring)

    def read(self, since: int, max_ticks: int, /) -> tuple[bytes, int, int]:
        first = max(since, self._lost_before)
        return b"".join(self._ring[first : first + max_ticks]), first, first - since

    def latest(self) -> bytes:
        return self._ring[-1] if self._ring else b""

    def status(self) -> ServoStatus | None:
        histogram: Any = dict.fromkeys(("count", "sum_ns", "max_ns", "p50_ns", "p99_ns", "p999_ns"), 1)
        histogram |= {"edges_ns": [0, 1000, 2000, 4000], "counts": [0, 1, 0]}
        return {
            "tick": self.head() - 1,
            "t_mono_ns": 0,
            "state": self.state,
            "interlocks": self._interlocks(),
            "phase": "running",
            "missed_ticks": 3,
            "requests_applied": len(self.requests),
            "identity": "twin:1",
            "scheduling": {
                "realtime": "preferred",
                "realtime_ok": True,
                "policy": "fifo",
                "priority": 80,
                "cpu": None,
                "memory_locked": True,
                "problems": [],
                "selftest_samples": 100,
                "selftest_median_ns": 50_000,
                "selftest_p99_ns": 90_000,
                "selftest_max_ns": 100_000,
            },
            "lateness": histogram,
            "exchange": histogram,
            "compute": histogram,
        }

    def servo_alive(self) -> bool:
        return self.alive

    def close(self) -> None:
        self.closed = True

    def _answer(self, request_id: int, request: dict[str, Any]) -> Ack:
        refused = self._carry_out(request)
        self.run()
        return {
            "id": request_id,
            "tick": self.head() - 1,
            "t_mono_ns": int(self.record["t_mono_ns"]),
            "result": "refused" if refused else "applied",
            "interlocks": refused,
            "state": self.state,
        }

    def _carry_out(self, request: dict[str, Any]) -> int:
        """Carries a request out; the interlocks against it, or 0."""
        match request:
            case {"type": "desired", "desired": "paused"} if self.state not in ("enabled", "paused"):
                return NOT_ENABLED
            case {"type": "desired", "desired": "enabled"} if self._interlocks():
                return self._interlocks()
            case {"type": "desired", "desired": desired}:
                self.state = desired
            case {"type": "estop"}:
                self.estop, self.state = True, "disabled"
            case {"type": "estop_ack"}:
                self.estop = False
            case {"type": "fault_ack", "faults": bits}:
                self.faults &= ~bits
                self.state = "fault" if self.faults else "disabled"
            case {"type": "scene", "scene": scene}:
                self.record["scene_revision"] = scene["revision"]
        return 0

    def _interlocks(self) -> int:
        return (ESTOP_LATCHED if self.estop else 0) | (FAULT_LATCHED if self.faults else 0)
