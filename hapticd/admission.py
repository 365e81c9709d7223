"""Whether a wall is let in: its stability budget, and what is granted of it."""

from __future__ import annotations

from dataclasses import dataclass

from hapticd.analysis.device_stability import DeviceStability
from hapticd.analysis.stability import Advice, StabilityBudget
from hapticd.laws import Law
from hapticd.problem import Problem

FIELDS = {
    "motion": "eta",
    "spring": "stiffness_n_per_m",
    "damper": "damping_n_s_per_m",
    "cubic_damper": "coefficient_n_s3_per_m3",
}
"""The field of each law that makes it steep."""


@dataclass(frozen=True, slots=True)
class Admission:
    """A wall that is let in. ``passivity``: whether passivity must watch it, asked for or because of force.

    ``granted_n_per_m`` is None for a law without a spring.
    """

    granted_n_per_m: float | None
    passivity: bool
    forced: bool
    budget: StabilityBudget


def admit(stability: DeviceStability, law: Law, *, force: bool, pointer: str = "/law") -> Admission:
    """Lets a law in when the device bears it; over the limit only by ``force``, and then under passivity.

    ``pointer`` is the JSON pointer of the law in the caller's document. ``Problem``: over-stability-budget.
    """
    budget = stability.budget(law)
    over = budget.verdict == "unstable"
    if over and not force:
        raise _refusal(budget, f"{pointer}/{FIELDS[law.type]}")
    return Admission(budget.granted_n_per_m, law.passivity or over, over, budget)


def _refusal(budget: StabilityBudget, pointer: str) -> Problem:
    limit = next(limit for limit in budget.limits if limit.name == budget.binding)
    asked, unit = budget.granted_n_per_m, "N/m"
    if asked is None:
        asked, unit = budget.requested_n_s_per_m or 0.0, "N·s/m"
    detail = (
        f"The wall asks for {asked:.4g} {unit}. At {budget.rate_hz:g} Hz with {budget.delay_s * 1e3:.3g} ms"
        f" of delay the limit is {limit.value:.4g} {unit}: {limit.meaning}."
    )
    if budget.note is not None:
        detail = f"{detail} {budget.note}"
    return Problem("over-stability-budget", detail, hint=_cure(budget, limit.value, unit), pointer=pointer)


def _cure(budget: StabilityBudget, limit: float, unit: str) -> str:
    ask = f"Ask for at most {limit:.4g} {unit}, or send ?force=true: passivity then bounds the wall."
    return " ".join([ask, *(_advised(advice) for advice in budget.advice[:2])])


def _advised(advice: Advice) -> str:
    change = f"{advice.parameter} from {advice.present:.4g} to {advice.proposed:.4g} {advice.unit}"
    then = f"the {advice.limit} limit from {advice.limit_now:.4g} to {advice.limit_then:.4g}"
    return f"{advice.words} {change} raises {then}."
