"""The stability budget: how stiff a wall may be on a device, how stiff one is asked for, and what decides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from hapticd.analysis.device_loop import DeviceLoop
from hapticd.analysis.passivity_limit import abbott_okamura_n_per_m
from hapticd.analysis.settling_table import SettlingTable
from hapticd.analysis.wall_law import LawType, WallLaw
from hapticd.snapshot import Report

Verdict = Literal["passive", "stable", "unstable"]
LimitName = Literal["sampling", "resolution", "spring_drive", "tuning", "linear", "simulated", "damping"]

WORDS: dict[LimitName, str] = {
    "sampling": "friction must take up what sampling and delay give (Colgate & Schenkel)",
    "resolution": "dry friction must take up what the encoders' steps give (Abbott & Okamura)",
    "spring_drive": "the spring drive is passive up to the spring of its inductance, K_DC ≤ K_HF",
    "tuning": "the spring drive gives no more than it is tuned to, k_c",
    "linear": "the sampled loop without operator and dry friction oscillates above",
    "simulated": "the twin under a gentle push no longer comes to rest above",
    "damping": "the sampled loop oscillates with a damper above",
}
"""What each limit means."""

LINEAR_ONLY = "The twin's limit is still being simulated; until it is there the linear limit decides."


class Limit(Report):
    """One limit of stiffness, N/m, or of damping, N·s/m (``damping``)."""

    name: LimitName
    value: float
    meaning: str


class Advice(Report):
    """One parameter that would raise a limit: from and to which value, and what the limit then is."""

    parameter: str
    present: float
    proposed: float
    unit: str
    limit: LimitName
    limit_now: float
    limit_then: float
    words: str


class StabilityBudget(Report):
    """What a wall asks of a device, and what the device can bear. Null is what is not known or not asked.

    ``largest_passive_n_per_m`` is passive by itself whatever the hand does, ``largest_linear_n_per_m`` stable
    without hand and dry friction, ``largest_simulated_n_per_m`` the stiffest that came to rest on the twin;
    all three together with the damping asked for. ``margin`` is the largest stable over the requested value;
    ``verdict`` is ``passive``, ``stable`` or ``unstable``; ``binding`` names the limit that decides.
    """

    law: LawType
    rate_hz: float
    delay_s: float
    requested_n_per_m: float | None
    requested_n_s_per_m: float | None
    granted_n_per_m: float | None
    largest_passive_n_per_m: float
    largest_linear_n_per_m: float
    largest_simulated_n_per_m: float | None
    largest_damping_n_s_per_m: float
    margin: float | None
    verdict: Verdict
    binding: LimitName
    limits: list[Limit]
    note: str | None = None
    advice: tuple[Advice, ...] = ()


@dataclass(frozen=True, slots=True)
class Simulated:
    """What the twin says: a table, or, before it is there, whether the very wall asked for came to rest."""

    table: SettlingTable | None = None
    requested_settles: bool | None = None


def passive_limits(loop: DeviceLoop, damping_n_s_per_m: float) -> dict[LimitName, float]:
    """The limits of passivity with this damping, N/m."""
    limits: dict[LimitName, float] = {
        "sampling": loop.sampled.largest_stiffness_n_per_m(damping_n_s_per_m),
        "resolution": abbott_okamura_n_per_m(loop.tip.coulomb_n, loop.tip.quantum_m),
    }
    if loop.coupling.is_spring_drive:
        limits["spring_drive"] = loop.coupling.series_n_per_m
    return limits


@lru_cache(maxsize=256)
def stability_budget(loop: DeviceLoop, law: WallLaw, simulated: Simulated) -> StabilityBudget:
    """The budget of one wall. About 3 ms the first time: nothing is simulated here."""
    granted, damping = law.stiffness_n_per_m, law.damping_n_s_per_m
    limits = passive_limits(loop, damping)
    largest_passive = min(limits.values())
    if loop.coupling.is_spring_drive:
        limits["tuning"] = loop.coupling.stiffness_n_per_m
        granted = min(granted, loop.coupling.stiffness_n_per_m)
    limits["linear"] = loop.linear.largest_stiffness_n_per_m(damping)
    limits["damping"] = loop.linear.largest_damping_n_s_per_m()
    if simulated.table is not None:
        limits["simulated"] = simulated.table.largest_stiffness_n_per_m(damping)
    verdict, binding, margin = _judged(law, granted, largest_passive, limits, simulated)
    return StabilityBudget(
        law=law.type,
        rate_hz=loop.rate_hz,
        delay_s=loop.delay_s,
        requested_n_per_m=law.stiffness_n_per_m or None,
        requested_n_s_per_m=law.damping_n_s_per_m or None,
        granted_n_per_m=granted or None,
        largest_passive_n_per_m=largest_passive,
        largest_linear_n_per_m=limits["linear"],
        largest_simulated_n_per_m=limits.get("simulated"),
        largest_damping_n_s_per_m=limits["damping"],
        margin=margin,
        verdict=verdict,
        binding=binding,
        limits=[Limit(name=name, value=value, meaning=WORDS[name]) for name, value in limits.items()],
        note=None if simulated.table is not None or granted == 0.0 else LINEAR_ONLY,
    )


def _judged(
    law: WallLaw, granted: float, passive: float, limits: dict[LimitName, float], simulated: Simulated
) -> tuple[Verdict, LimitName, float | None]:
    if granted == 0.0:
        return _judged_damper(law, passive, limits["damping"])
    stable: LimitName = "simulated" if "simulated" in limits else "linear"
    margin = limits[stable] / granted
    if granted <= passive:
        return "passive", _tightest(limits), margin
    if granted <= limits[stable] or (stable == "linear" and simulated.requested_settles):
        tuned = limits.get("tuning", float("inf")) < limits[stable]
        return "stable", "tuning" if tuned else stable, margin
    return "unstable", stable, margin


def _judged_damper(
    law: WallLaw, passive: float, largest_damping: float
) -> tuple[Verdict, LimitName, float | None]:
    asked = law.damping_n_s_per_m
    margin = largest_damping / asked if asked > 0.0 else None
    if passive > 0.0:
        return "passive", "damping", margin
    return "stable" if law.bounded or asked <= largest_damping else "unstable", "damping", margin


def _tightest(limits: dict[LimitName, float]) -> LimitName:
    stiffness = {name: value for name, value in limits.items() if name != "damping"}
    return min(stiffness, key=lambda name: stiffness[name])
