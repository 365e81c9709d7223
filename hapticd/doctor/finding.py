"""A finding: what was looked at, how it is, why that matters, and what cures it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """How bad a finding is."""

    OK = "ok"
    WARN = "warn"
    """The daemon runs, worse than it could."""
    FAIL = "fail"
    """The daemon does not start, or a configured device cannot be enabled."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the doctor's report. ``cure`` is a command or a sentence, none where there is no need."""

    subject: str
    verdict: Verdict
    detail: str
    cure: str | None = None


def ok(subject: str, detail: str) -> Finding:
    """Nothing to be done."""
    return Finding(subject, Verdict.OK, detail)


def warn(subject: str, detail: str, cure: str) -> Finding:
    """Worth doing something about."""
    return Finding(subject, Verdict.WARN, detail, cure)


def fail(subject: str, detail: str, cure: str) -> Finding:
    """Must be mended."""
    return Finding(subject, Verdict.FAIL, detail, cure)
