"""What KS §5 say about friction, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping

from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Claim
from hapticd.experiments.friction_drag import STRENGTHS, SYSTEMS, Drag
from hapticd.experiments.friction_rule import Coast

Drags = Mapping[tuple[str, str], Drag]

SAME_N = 1.5
"""Differences below this count as the same: the ripple of the brakes."""

NOTHING = 0.01
"""Share of the hand's work that counts as none: what a spring of the friction's stiffness gives back."""


def claims(
    drags: Drags, stiffest: Mapping[str, float | None], coasts: Mapping[str, Coast]
) -> tuple[Claim, ...]:
    """The statements on Figs. 10, 11 and 12."""
    return (
        _computed(drags),
        *(_transition(system, drags["weak", system]) for system in SYSTEMS),
        _no_active_motion(drags),
        _brakes_passive(drags),
        _printed_rule(coasts),
        _unstable(drags, stiffest),
        _suited(),
    )


def _computed(drags: Drags) -> Claim:
    told = ", ".join(
        f"{' '.join(case)} {drag.friction_error_n:+.1f} N on {drag.computed_kinetic_n:.1f} N"
        for case, drag in drags.items()
    )
    errors = {system: [drags[s, system].friction_error_n for s in STRENGTHS] for system in SYSTEMS}
    return judged(
        "The computed friction differs from the measured one by the friction of the mechanism",
        "KS §5, Fig. 11: “a little”",
        f"more is measured than computed, as much under the weak push as under the strong one ± {SAME_N} N",
        told,
        holds=all(min(pair) > 0.0 and max(pair) - min(pair) < SAME_N for pair in errors.values()),
    )


def _transition(system: str, drag: Drag) -> Claim:
    drop = drag.static_peak_n / drag.kinetic_n
    return judged(
        f"Weak, {system}: static friction rises gradually, drops suddenly and becomes dynamic friction",
        "KS §5, Fig. 11 (the text says Fig. 10(b))",
        "at rest while the pull rises, a peak of at least 1.15 times the dynamic friction",
        f"{drag.static_peak_n:.1f} N, then {drag.kinetic_n:.1f} N; {1e3 * drag.creep_m:.2f} mm before slip",
        holds=drop > 1.15 and drag.creep_m < 2e-3,
    )


def _no_active_motion(drags: Drags) -> Claim:
    return _passive(
        "Friction by motors that is kept below the pull of the hand causes no active motion", "active", drags
    )


def _brakes_passive(drags: Drags) -> Claim:
    return _passive("Friction by brakes needs no concern about active motion", "hybrid", drags)


def _passive(claim: str, system: str, drags: Drags) -> Claim:
    pairs = {s: (drags[s, system].active_work_j, drags[s, system].hand_work_j) for s in STRENGTHS}
    told = ", ".join(
        f"{s} {1e3 * given:.2f} mJ of {1e3 * put_in:.0f} mJ" for s, (given, put_in) in pairs.items()
    )
    return judged(
        claim,
        "KS §5",
        f"the device pushes the tip along with less than {100 * NOTHING:.0f} % of the hand's work",
        told,
        holds=all(given < NOTHING * put_in for given, put_in in pairs.values()),
    )


def _printed_rule(coasts: Mapping[str, Coast]) -> Claim:
    old, new = coasts["printed"], coasts["corrected"]
    return judged(
        "Friction restricted to at most the hand's pull F_hx is friction (misprint: it vanishes in slip)",
        "KS §5",
        "a moving tip that the hand leaves to itself, still pressed on, is stopped by μN",
        f"as printed {old.force_after_n:.1f} N and {1e3 * old.coast_m:.1f} mm of coasting; "
        f"corrected {new.force_after_n:.1f} N and {1e3 * new.coast_m:.1f} mm",
        holds=old.coast_m < 1.5 * new.coast_m,
    )


def _unstable(drags: Drags, stiffest: Mapping[str, float | None]) -> Claim:
    swings = ", ".join(f"{name} swings {1e6 * drags['strong', name].swing_m:.0f} µm" for name in SYSTEMS)
    limits = ", ".join(f"{name} up to {(k or 0.0) / 1e3:.0f} kN/m" for name, k in stiffest.items())
    return judged(
        "Strong: the active system is more likely to become unstable than the hybrid one",
        "KS §5, Fig. 12(a)",
        "the active system moves at rest, or stands less stiffness of the wall than the hybrid one",
        f"rigid wall: {swings}; comes to rest on walls: {limits}",
        holds=_less_stable(drags, stiffest),
    )


def _less_stable(drags: Drags, stiffest: Mapping[str, float | None]) -> bool:
    active, hybrid = (stiffest[system] or 0.0 for system in ("active", "hybrid"))
    worse = not drags["strong", "active"].stable and drags["strong", "hybrid"].stable
    return worse or active < hybrid


def _suited() -> Claim:
    return undecidable(
        "The hybrid system suits pushing and sawing better",
        "KS §5, §6",
        "people prefer it",
        "forces and displacements only",
        "no operator judges a twin",
    )
