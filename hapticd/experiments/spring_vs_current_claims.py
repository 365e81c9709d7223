"""What WN say about spring drives beside current amplifiers, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Claim

AT_REST_M = 1e-4
"""Three encoder counts."""


def claims(results: Mapping[str, Any]) -> tuple[Claim, ...]:
    """Every statement of WN about current amplifiers that a number can decide, in each of its meanings."""
    last = results["compared"][-1]
    return (
        _passive(results, last),
        _stable(results, results["compared"][0], "without delay"),
        _stable(results, last, "with delay"),
        _independent(results),
        _leaks(results),
        _tuning(results, last),
        _harder(results["contact"]),
        _settles(results["contact"]),
        _feel(),
    )


def _mm(value: float) -> str:
    return f"{value / 1e3:.2f}"


def _where(row: Mapping[str, Any]) -> str:
    return f"at {row['rate_hz']:g} Hz and {row['delay_ticks']} tick(s) of delay"


def _passive(results: Mapping[str, Any], row: Mapping[str, Any]) -> Claim:
    spring, current = row["spring_passive_n_per_m"], row["current_passive_n_per_m"]
    fast = results["series_stiffness_n_per_m"]
    return judged(
        "Spring drives give stronger position feedback than current amplifiers can, as a passive coupling",
        "WN abstract, §I",
        "larger passive stiffness than a digital spring, static and fast",
        f"{_mm(spring)} static and {_mm(fast)} fast against {_mm(current)} N/mm {_where(row)}",
        holds=spring > current,
    )


def _stable(results: Mapping[str, Any], row: Mapping[str, Any], which: str) -> Claim:
    spring, current = row["spring_stable_n_per_m"], row["current_stable_n_per_m"]
    fast = results["series_stiffness_n_per_m"]
    return judged(
        "Spring drives give stronger position feedback than current amplifiers can, as a stable linear loop, "
        + which,
        "WN abstract, §I",
        "larger stable stiffness than a digital spring with the best digital damping",
        f"{_mm(spring)} static and {_mm(fast)} fast against {_mm(current)} N/mm {_where(row)}; "
        f"without digital damping {_mm(row['current_undamped_n_per_m'])} N/mm",
        holds=max(spring, fast) > current,
    )


def _independent(results: Mapping[str, Any]) -> Claim:
    spread = [np.ptp(one["spring_passive_n_per_m"]) for one in results["limits"]]
    fast = results["series_stiffness_n_per_m"]
    slowest = min(min(one["spring_stable_n_per_m"]) for one in results["limits"])
    return judged(
        "The spring of the inductance is there at every frequency and rate, and inherently stable",
        "WN §II, after eq. 5",
        "K_L without any sampling; some feedback beside it stable at every rate and delay",
        f"K_L = {_mm(fast)} N/mm; feedback up to {_mm(slowest)} N/mm stable at the slowest rate; its "
        f"passive limit varies by {_mm(max(spread))} N/mm with the rate",
        holds=slowest > 0.0,
    )


def _leaks(results: Mapping[str, Any]) -> Claim:
    one = results["limits"][0]
    rate, passive = np.array(one["rate_hz"]), np.array(one["current_passive_n_per_m"])
    slope = float(np.polyfit(np.log(rate), np.log(passive), 1)[0])
    return judged(
        "Energy leaks of sampling and quantisation limit the gains of digital springs",
        "WN §I",
        "passive stiffness 2b/T, in proportion to the rate, and 2 f_c/Δ",
        f"∝ rate^{slope:.2f}, {_mm(passive[0])}…{_mm(passive[-1])} N/mm from {rate[0]:g} to {rate[-1]:g} Hz; "
        f"2 f_c/Δ = {_mm(results['by_resolution_n_per_m'])} N/mm",
        holds=abs(slope - 1.0) < 0.05,
    )


def _tuning(results: Mapping[str, Any], row: Mapping[str, Any]) -> Claim:
    tuned, limit = results["tuned_stiffness_n_per_m"], row["spring_passive_n_per_m"]
    return judged(
        "The tuning locked in place is a passive coupling, its sampling and delay included",
        "WN §III, end",
        f"K_DC = {_mm(tuned)} N/mm within the sampled limit",
        f"limit {_mm(limit)} N/mm {_where(row)}; by resolution {_mm(results['by_resolution_n_per_m'])} N/mm",
        holds=tuned <= limit,
    )


def _harder(contact: Mapping[str, Mapping[str, float]]) -> Claim:
    spring = contact["spring_drive"]["rate_hardness_n_per_m"]
    others = {name: one["rate_hardness_n_per_m"] for name, one in contact.items() if name != "spring_drive"}
    return judged(
        "Spring drives improve rigid contact: the force rises faster for the speed of impact",
        "WN abstract, §II",
        "rate-hardness above that of the passive digital spring and of a bare one of equal static stiffness",
        f"{_mm(spring)} against {_mm(others['current_passive'])} (passive), "
        f"{_mm(others['current_bare'])} (bare) and {_mm(others['current_damped'])} N/mm (digitally damped)",
        holds=spring > max(others["current_passive"], others["current_bare"]),
    )


def _settles(contact: Mapping[str, Mapping[str, float]]) -> Claim:
    residual = {name: one["residual_m"] for name, one in contact.items()}
    said = ", ".join(f"{name} {1e3 * value:.2f}" for name, value in residual.items())
    return judged(
        "A spring drive comes to rest at a wall where a bare digital spring of equal stiffness does not",
        "WN §I, §II",
        f"motion at the end below {1e3 * AT_REST_M:g} mm, and above it",
        f"mm from end to end: {said}",
        holds=residual["spring_drive"] < AT_REST_M < residual["current_bare"],
    )


def _feel() -> Claim:
    return undecidable(
        "The higher stiffness improves perception and the user's experience",
        "WN §VII",
        "people's judgement",
        "not tried",
        "the text reports no study, and nobody feels a twin",
    )
