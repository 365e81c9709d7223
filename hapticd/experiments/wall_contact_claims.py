"""What KS §4 say about contact with a hard wall, and whether it is so."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Claim
from hapticd.experiments.wall_contact_strike import Strike

Strikes = Mapping[tuple[str, str], Strike]

SMALL_M = 5e-4
"""A steady-state error that KS call small: under half of the 1.2 mm that they call large."""

CREEP_M_PER_S = 5e-3
STILL_M_PER_S = 0.5e-3
"""The tip creeps in faster than the first until the brakes have it, and then rests."""

SMOOTH_S = 0.01
"""Over which the speed is averaged: the printed damper chatters."""

PRINTED_C = 1.6e6
"""N·s³/m³ (KS §4)."""


@dataclass(frozen=True, slots=True)
class Statement:
    """What KS say about one contact, and when that is so."""

    contact: tuple[str, str]
    claim: str
    source: str
    expected: str
    holds: Callable[[Strike], bool]

    def judged(self, strikes: Strikes) -> Claim:
        """The claim, decided by the contact it is about."""
        strike = strikes[self.contact]
        return judged(self.claim, self.source, self.expected, _told(strike), holds=self.holds(strike))


STATEMENTS = (
    Statement(
        ("weak", "active"),
        "Weak, active: bounces while it settles, then a very small error",
        "KS Fig. 8(a)",
        "bounces within about 0.11 s, error far below 1.2 mm",
        lambda strike: strike.bounces >= 1 and _rests(strike, 0.0, SMALL_M),
    ),
    Statement(
        ("weak", "popc"),
        "Weak, PO/PC: one bounce, then a small error",
        "KS Fig. 8(b)",
        "one bounce, settled, error small",
        lambda strike: strike.bounces == 1 and _rests(strike, 0.0, SMALL_M),
    ),
    Statement(
        ("weak", "hybrid"),
        "Weak, hybrid: no bounce, an error of 1.2 mm after about 0.11 s",
        "KS Fig. 8(c)",
        "no bounce, 0.6–2.4 mm",
        lambda strike: strike.bounces == 0 and _rests(strike, 0.6e-3, 2.4e-3),
    ),
    Statement(
        ("strong", "active"),
        "Strong, active: unstable oscillation with big bounces",
        "KS Fig. 9(a)",
        "never at rest",
        lambda strike: not strike.settled,
    ),
    Statement(
        ("strong", "popc"),
        "Strong, PO/PC: one big bounce, then stable with a small error",
        "KS Fig. 9(b)",
        "one bounce, settled, error small",
        lambda strike: strike.bounces == 1 and _rests(strike, 0.0, 2 * SMALL_M),
    ),
    Statement(
        ("strong", "hybrid"),
        "Strong, hybrid: no bounce, stable, an error of up to about 20 mm",
        "KS Fig. 9(c)",
        "no bounce, 5–25 mm",
        lambda strike: strike.bounces == 0 and _rests(strike, 5e-3, 25e-3),
    ),
)


def claims(strikes: Strikes) -> tuple[Claim, ...]:
    """The statements on Figs. 8 and 9, and Table 1."""
    return (
        _damper_law(),
        _forces(strikes),
        *(statement.judged(strikes) for statement in STATEMENTS),
        _sharp_drop(strikes["weak", "hybrid"]),
        _table(strikes),
        _own(strikes),
        _feel(),
    )


def _damper_law() -> Claim:
    force_n = PRINTED_C * 0.04**3
    return judged(
        "F = 1 600 000 v³ gives 100 N from 40 mm/s on",
        "KS §4, Fig. 7",
        "100 N at 40 mm/s",
        f"{force_n:.1f} N; 100 N at {1e3 * np.cbrt(100.0 / PRINTED_C):.1f} mm/s",
        holds=abs(force_n - 100.0) < 5.0,
    )


def _forces(strikes: Strikes) -> Claim:
    weak = [strike.numbers()["steady_force_n"] or 0.0 for (s, _), strike in strikes.items() if s == "weak"]
    strong = [strike.numbers()["peak_force_n"] or 0.0 for (s, _), strike in strikes.items() if s == "strong"]
    return judged(
        "The operator feels 20–30 N in weak contact and over 100 N in strong contact",
        "KS §4",
        "20–30 N steady, more than 100 N at the peak",
        f"{min(weak):.0f}–{max(weak):.0f} N steady; peak {min(strong):.0f}–{max(strong):.0f} N",
        holds=min(weak) > 18.0 and max(weak) < 32.0 and min(strong) > 95.0,
    )


def _sharp_drop(strike: Strike) -> Claim:
    window = np.full(max(1, round(SMOOTH_S * strike.rate_hz)), 1.0)
    speed = np.convolve(strike.speed_m_per_s[strike.watched], window / len(window), mode="same")
    creeping, still = (_last_above(speed, limit) / strike.rate_hz for limit in (CREEP_M_PER_S, STILL_M_PER_S))
    return judged(
        "Weak, hybrid: the speed falls sharply at the end of the transient",
        "KS Fig. 8(c): at 0.12 s",
        "from 5 to 0.5 mm/s within 40 ms, for good",
        f"within {1e3 * (still - creeping):.0f} ms, at {still:.2f} s after the contact",
        holds=strike.settled and 0.0 < still - creeping < 0.04,
    )


def _last_above(speed: NDArray[np.float64], limit: float) -> float:
    above = np.flatnonzero(speed > limit)
    return float(above[-1]) if len(above) else 0.0


def _table(strikes: Strikes) -> Claim:
    errors = {wall: _error(strikes["weak", wall]) for wall in ("active", "popc", "hybrid")}
    told = ", ".join(f"{wall} {1e3 * error:.2f} mm" for wall, error in errors.items())
    calm = not strikes["strong", "active"].settled and strikes["strong", "hybrid"].settled
    return judged(
        "Small error for the springs, large for the hybrid; the active one oscillates, the hybrid does not",
        "KS Table 1",
        "hybrid error more than twice the others' in weak contact; strong active never rests, hybrid does",
        told,
        holds=calm and errors["hybrid"] > 2.0 * max(errors["active"], errors["popc"]),
    )


def _own(strikes: Strikes) -> Claim:
    own, bare = (
        {strength: strikes[strength, wall] for strength in ("weak", "strong")}
        for wall in ("passivity", "active")
    )
    returned = {strength: strike.returned_energy_j for strength, strike in own.items()}
    before = max(strike.returned_energy_j for strike in bare.values())
    return judged(
        "The daemon's own passivity control lets a wall return no more than it took, and it comes to rest",
        "docs/passivity.md, beyond KS",
        "at rest in both contacts, at most 5 mJ returned",
        f"weak {_told(own['weak'])}; strong {_told(own['strong'])}; returned "
        f"{1e3 * max(returned.values()):.1f} mJ against {1e3 * before:.0f} mJ without",
        holds=all(strike.settled for strike in own.values()) and max(returned.values()) < 5e-3,
    )


def _feel() -> Claim:
    return undecidable(
        "The hybrid wall feels more realistic at high speed",
        "KS §4, Table 1",
        "people prefer it",
        "force and displacement only",
        "no operator judges a twin; the force against displacement is drawn for comparison",
    )


def _rests(strike: Strike, low_m: float, high_m: float) -> bool:
    return low_m < _error(strike) < high_m


def _error(strike: Strike) -> float:
    error = strike.steady_error_m
    return float("inf") if error is None else error


def _told(strike: Strike) -> str:
    found = strike.numbers()
    speed = f"{found['contact_speed_m_per_s']:.2f} m/s, "
    bounces = f"{found['bounces']} bounces, peak {1e3 * (found['peak_penetration_m'] or 0.0):.2f} mm, "
    if not strike.settled:
        return speed + bounces + f"not at rest: {1e3 * strike.unrest_m:.2f} mm peak to peak at the end"
    return speed + bounces + f"error {1e3 * _error(strike):.2f} mm after {found['settling_s']:.2f} s"
