"""Under which conditions a scene is edited."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """``if_match``: only if the scene still has one of these entity tags. ``dry_run``: check, change nothing.
    ``force``: let walls in over their stability budget, with passivity.
    """

    if_match: str | None = None
    dry_run: bool = False
    force: bool = False


PLAIN = Terms()
"""No conditions."""
