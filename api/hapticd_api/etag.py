"""Entity tags of readings: `If-None-Match` over strong tags (RFC 9110 §13.1.2)."""

from __future__ import annotations

import re

_TAG = re.compile(r'(?:W/)?("[^"]*")')


def is_fresh(if_none_match: str | None, present: str) -> bool:
    """Whether the caller's copy still is the present one; the comparison is weak, as the RFC asks."""
    if if_none_match is None:
        return False
    return if_none_match.strip() == "*" or present in _TAG.findall(if_none_match)
