"""Distributions of durations, from the servo's histograms and from cyclictest, in one form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Durations:
    """Counts per bucket; ``edges_ns[i]`` is the upper edge of bucket ``i``. ``max_ns`` is exact."""

    edges_ns: tuple[float, ...]
    counts: tuple[int, ...]
    max_ns: float

    @property
    def count(self) -> int:
        return sum(self.counts)

    def quantile_us(self, share: float) -> float:
        """Upper edge of the bucket that holds the quantile, µs."""
        wanted, seen = share * self.count, 0
        for edge_ns, count in zip(self.edges_ns, self.counts, strict=True):
            seen += count
            if seen >= wanted:
                return min(edge_ns, self.max_ns) / 1e3
        return self.max_ns / 1e3

    def row(self, what: str, note: str = "") -> str:
        """One line of the page: p50, p99, p99.9, maximum in µs."""
        quantiles = "".join(f"{self.quantile_us(share):10.1f}" for share in (0.5, 0.99, 0.999))
        return f"  {what:<34}{quantiles}{self.max_ns / 1e3:10.0f}  {note}"


HEADER = f"  {'':<34}{'p50':>10}{'p99':>10}{'p99.9':>10}{'max':>10}  µs"


def between(before: Mapping[str, Any], after: Mapping[str, Any]) -> Durations:
    """What a servo's histogram gained between two reports. The maximum is that since start."""
    old = list(before["counts"]) + [0] * (len(after["counts"]) - len(before["counts"]))
    counts = tuple(new - was for new, was in zip(after["counts"], old, strict=True))
    return Durations(tuple(after["edges_ns"][1:]), counts, after["max_ns"])
