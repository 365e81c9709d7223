"""Back-off: longer and longer pauses between attempts, with jitter so that several do not beat in step."""

from __future__ import annotations

import random


class Backoff:
    """Pauses that double from ``first_s`` to ``longest_s``, each shortened by up to a quarter at random."""

    def __init__(self, first_s: float = 0.2, longest_s: float = 10.0) -> None:
        self._first_s = first_s
        self._longest_s = longest_s
        self._next_s = first_s

    def pause_s(self) -> float:
        """The next pause."""
        pause_s = self._next_s
        self._next_s = min(2.0 * pause_s, self._longest_s)
        return pause_s * random.uniform(0.75, 1.0)

    def reset(self) -> None:
        """Starts again at the shortest pause: the last attempt went well."""
        self._next_s = self._first_s
