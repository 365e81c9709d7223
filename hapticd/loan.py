"""A device lent: for a while one holder alone says what it renders and what its hand does."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from hapticd.problem import Problem
from hapticd.snapshot import Applied
from hapticd.twin import EMPTY_SCENE

Apply = Callable[[Mapping[str, Any], float], Awaitable[Applied]]
"""Sends one request to the loop, with the time it fades over."""


class Loan:
    """What the holder of a device may do with it. Nothing any more once the device is given back.

    ``scene_changed`` and ``hand_changed`` say what has to be put back.
    """

    def __init__(self, apply: Apply, next_revision: Callable[[], int]) -> None:
        self._apply = apply
        self._next_revision = next_revision
        self._over = False
        self.scene_changed = False
        self.hand_changed = False

    async def scene(self, scene: Mapping[str, Any]) -> None:
        """Renders a flat scene; what it leaves out is as in ``EMPTY_SCENE``. Raises ``Problem``."""
        self._check()
        self.scene_changed = True
        flat = {**EMPTY_SCENE, **scene, "revision": self._next_revision()}
        await self._apply({"type": "scene", "scene": flat}, float(flat["fade_s"]))

    async def hand(self, script: Mapping[str, Any]) -> None:
        """Tells the hand what to do, its vectors three wide. Raises ``Problem``."""
        self._check()
        self.hand_changed = True
        await self._apply({"type": "hand", "script": dict(script)}, 0.0)

    def end(self) -> None:
        """The device has been given back."""
        self._over = True

    def _check(self) -> None:
        if self._over:
            raise Problem("device-lent", "The device was given back: the loan is over.", retryable=False)
