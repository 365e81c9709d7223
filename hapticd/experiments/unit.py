"""The unit that a name ends in."""

from __future__ import annotations

SYMBOLS = {
    "m": "m",
    "m2": "m²",
    "m3": "m³",
    "rad": "rad",
    "s": "s",
    "s2": "s²",
    "s3": "s³",
    "n": "N",
    "nm": "N·m",
    "kg": "kg",
    "hz": "Hz",
    "a": "A",
    "v": "V",
    "h": "H",
    "ohm": "Ω",
    "c": "°C",
    "k": "K",
    "w": "W",
    "j": "J",
    "deg": "°",
    "ticks": "ticks",
}


def unit_of(name: str) -> str:
    """The unit by the suffix of a name: ``stiffness_n_per_m`` is in N/m, ``lag_scale`` in 1."""
    _, *rest = name.split("_")
    numerator, denominator = _suffix(rest)
    top = "·".join(SYMBOLS[token] for token in numerator) or "1"
    return f"{top}/{'·'.join(SYMBOLS[token] for token in denominator)}" if denominator else top


def _suffix(tokens: list[str]) -> tuple[list[str], list[str]]:
    """The units at the end of a name, above and below the fraction bar."""
    above: list[str] = []
    below: list[str] = []
    for token in reversed(tokens):
        if token == "per" and not below:
            above, below = [], above
        elif token in SYMBOLS:
            above.insert(0, token)
        else:
            break
    return above, below
