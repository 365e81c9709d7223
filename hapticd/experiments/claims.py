"""Verdicts on claims: a number against a bound, a yes or no, or neither with the reason."""

from __future__ import annotations

from hapticd.experiments.experiment import Claim


def judged(claim: str, source: str, expected: str, measured: str, *, holds: bool) -> Claim:
    """A claim that the measurement decides."""
    return Claim(claim, source, expected, measured, "holds" if holds else "fails")


def undecidable(claim: str, source: str, expected: str, measured: str, reason: str) -> Claim:
    """A claim that nothing here can decide; ``reason`` says what is missing."""
    return Claim(claim, source, expected, measured, "undecidable", reason)
