"""One contact with a hard wall on the twin, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.run import Run
from hapticd.experiments.wall_contact_approach import ready
from hapticd.experiments.wall_contact_popc import PopcBench
from hapticd.flat_wall import flat_plane
from hapticd.twin import TwinRun

Vector = NDArray[np.float64]

STRENGTHS = ("weak", "strong")

BOUNCE_M = 1e-4
"""The tip has bounced when it is this far out of the wall again (physics §9)."""

SETTLED_M = 1e-4
"""The tip rests when it stays within this."""

REST_S = 0.2
"""The end of the watch, over which the steady error is the mean."""

WITHDRAW_S = 0.5


def _spring(run: Run) -> dict[str, Any]:
    return {
        "type": "spring",
        "stiffness_n_per_m": run.number("stiffness_n_per_m"),
        "damping_n_s_per_m": 0.0,
    }


def _damper(run: Run) -> dict[str, Any]:
    return {
        "type": "cubic_damper",
        "coefficient_n_s3_per_m3": run.number("coefficient_n_s3_per_m3"),
        "form": run.word("form"),
    }


POPC = "popc"

RENDERED: Mapping[str, tuple[Callable[[Run], dict[str, Any]], dict[str, Any]]] = {
    "active": (_spring, {"passivity": False, "brake": False}),
    "passivity": (_spring, {"passivity": True, "brake": False}),
    "hybrid": (_damper, {"passivity": False, "brake": True}),
}
"""Law and switches of each wall that hapticd renders (KS Table 1)."""

WALLS = ("active", POPC, "passivity", "hybrid")
"""Every wall that is struck; ``popc`` is passivity control as published."""


@dataclass(frozen=True)
class Strike:
    """Records from shortly before the contact until the hand has been withdrawn."""

    records: NDArray[Any]
    contact: int
    wall_y_m: float
    rate_hz: float
    watch_s: float

    @property
    def time_s(self) -> Vector:
        """Time from the contact."""
        return (np.arange(len(self.records)) - self.contact) / self.rate_hz

    @property
    def depth_m(self) -> Vector:
        """Depth of the tip in the wall; negative outside."""
        return np.asarray(self.records["tip_position_m"][:, 1] - self.wall_y_m)

    @property
    def force_n(self) -> Vector:
        """Force of the hand on the wall, as the sensor reads it."""
        return np.asarray(self.records["sensor_force_n"][:, 1])

    @property
    def speed_m_per_s(self) -> Vector:
        """Speed of the tip into the wall."""
        return np.asarray(self.records["tip_velocity_m_per_s"][:, 1])

    @property
    def watched(self) -> slice:
        """The ticks between the contact and the withdrawal."""
        return slice(self.contact, self.contact + round(self.watch_s * self.rate_hz))

    @property
    def bounces(self) -> int:
        """Times the tip leaves the wall again by more than ``BOUNCE_M``."""
        out = self.depth_m[self.watched] < -BOUNCE_M
        return int(np.sum(out[1:] & ~out[:-1]))

    @property
    def unrest_m(self) -> float:
        """Peak to peak of the depth over the last ``REST_S`` of the watch."""
        return float(np.ptp(self._last))

    @property
    def settled(self) -> bool:
        """Whether the tip came to rest in the wall."""
        return self.unrest_m < SETTLED_M and float(self._last.min()) > -BOUNCE_M

    @property
    def steady_error_m(self) -> float | None:
        """Mean depth at rest; none where there is no rest."""
        return float(self._last.mean()) if self.settled else None

    @property
    def settling_s(self) -> float | None:
        """Time from the contact until the depth stays within ``SETTLED_M`` of its end."""
        if not self.settled:
            return None
        away = np.abs(self.depth_m[self.watched] - self._last.mean()) > SETTLED_M
        return float(len(away) - np.argmax(away[::-1])) / self.rate_hz if away.any() else 0.0

    @property
    def _last(self) -> Vector:
        return self.depth_m[self.watched][-round(REST_S * self.rate_hz) :]

    def numbers(self) -> dict[str, float | int | bool | None]:
        """What the figures of KS show."""
        depth, force = self.depth_m[self.watched], self.force_n[self.watched]
        return {
            "contact_speed_m_per_s": float(self.speed_m_per_s[self.contact]),
            "bounces": self.bounces,
            "peak_penetration_m": float(depth.max()),
            "steady_error_m": self.steady_error_m,
            "settling_s": self.settling_s,
            "settled": self.settled,
            "unrest_m": self.unrest_m,
            "peak_force_n": float(force.max()),
            "steady_force_n": float(force[-round(REST_S * self.rate_hz) :].mean()),
            "returned_energy_j": self.returned_energy_j,
        }

    @property
    def returned_energy_j(self) -> float:
        """Largest energy by which the outputs gave back more than they had taken from the hand."""
        return float(max(0.0, -self.records["device_energy_j"][self.watched].min()))

    def trace(self) -> dict[str, Vector]:
        """Depth, force and speed over time, as KS draw them."""
        return {
            "t_s": self.time_s,
            "depth_m": self.depth_m,
            "force_n": self.force_n,
            "speed_m_per_s": self.speed_m_per_s,
            "motor_force_n": -np.asarray(self.records["tip_force_command_n"][:, 1]),
        }


def struck(run: Run, wall: str, script: Mapping[str, Any]) -> Strike:
    """Drives the twin's hand into the wall, watches, and withdraws it. ``ValueError``: it never arrived."""
    wall_y_m, rate_hz, watch_s = (run.number(name) for name in ("wall_y_m", "rate_hz", "watch_s"))
    bench = PopcBench(run) if wall == POPC else _among(run, wall)
    bench.hand(script)
    approach = bench.run(2.0 + watch_s)
    inside = approach["tip_position_m"][:, 1] > wall_y_m
    if not inside.any():
        raise ValueError("The hand never reached the wall: push harder or start nearer.")
    contact = int(np.argmax(inside))
    begin, end = max(0, contact - round(0.05 * rate_hz)), contact + round(watch_s * rate_hz)
    bench.hand({"type": "follow", "target_m": [0.0, run.number("start_y_m"), 0.0]})
    records = np.concatenate([approach[begin:end], bench.run(WITHDRAW_S)])
    return Strike(records, contact - begin, wall_y_m, rate_hz, watch_s)


def _among(run: Run, wall: str) -> TwinRun:
    law, switches = RENDERED[wall]
    return ready(run, [flat_plane([0.0, -1.0, 0.0], -run.number("wall_y_m"), law(run), **switches)])
