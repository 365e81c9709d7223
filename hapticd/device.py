"""A device, as everything above the loop sees it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hapticd.channel import Channel, Link
from hapticd.config import DeviceConfig
from hapticd.events import EventLog
from hapticd.hand import HandScript, Hold, flat_script
from hapticd.injection import Injection
from hapticd.model import Model
from hapticd.problem import Problem
from hapticd.realtime import RealtimeReport
from hapticd.record import record_dtype
from hapticd.scene import Scene, Wall
from hapticd.scene_editor import SceneEditor
from hapticd.scene_store import SceneStore
from hapticd.snapshot import Applied, DeviceSnapshot, SceneResult


@dataclass(frozen=True)
class TickBatch:
    """Ticks read from the loop: ``records`` is a structured array of ``record_dtype()``, shape (n,).

    ``first`` is the number of its first tick, ``lost`` the ticks between ``since`` and it that are gone.
    """

    records: np.ndarray[Any, np.dtype[np.void]]
    first: int
    lost: int


class Device:
    """One configured device. Every coroutine raises ``Problem`` where the device refuses."""

    def __init__(self, config: DeviceConfig, model: Model, store: SceneStore, events: EventLog) -> None:
        self.device_id: str = config.id
        self.model_name: str = model.name
        self.dof: int = model.dof
        self.driver: str = config.driver
        self.is_twin: bool = config.is_twin
        self.rate_hz: float = config.rate_hz

    def snapshot(self) -> DeviceSnapshot:
        """Everything about the device at this instant."""

    async def set_desired(self, desired: str) -> Applied:
        """Asks for ``enabled``, ``disabled`` or ``paused``. ``Problem``: interlock-open, state-refused, device-offline."""

    async def engage_estop(self) -> Applied:
        """Latches the E-stop. Idempotent."""

    async def acknowledge_estop(self) -> Applied:
        """Clears the latched E-stop, if its source is gone."""

    async def acknowledge_fault(self, slug: str) -> Applied:
        """Clears one latched fault, if its cause is gone. ``Problem``: fault-not-found."""

    @property
    def scene(self) -> Scene: ...
    @property
    def scene_etag(self) -> str: ...

    async def replace_scene(
        self, scene: Scene, *, if_match: str | None = None, dry_run: bool = False
    ) -> SceneResult:
        """Puts another scene in force at one tick, faded so that no force steps."""

    async def edit_scene(
        self, change: Callable[[Scene], Scene], *, if_match: str | None = None, dry_run: bool = False
    ) -> SceneResult:
        """Puts what ``change`` makes of the present scene in force; no other edit comes between (for PATCH)."""

    async def put_wall(
        self, wall: Wall, *, if_match: str | None = None, dry_run: bool = False, create_only: bool = False
    ) -> SceneResult:
        """Adds a wall, or replaces its namesake unless ``create_only``."""

    async def delete_wall(self, wall_id: str, *, if_match: str | None = None, dry_run: bool = False) -> SceneResult:
        """Takes a wall away. ``Problem``: wall-not-found."""

    def get_wall(self, wall_id: str) -> Wall:
        """The wall of this id. ``Problem``: wall-not-found."""

    @property
    def hand(self) -> HandScript:
        """What the twin's hand was last told. ``Problem``: not-a-twin."""

    async def set_hand(self, script: HandScript) -> Applied:
        """Tells the twin's hand what to do. ``Problem``: not-a-twin, dimension-mismatch."""

    async def inject(self, injection: Injection) -> Applied:
        """Injects a fault into the twin. ``Problem``: not-a-twin."""

    def realtime(self) -> RealtimeReport | None:
        """Scheduling really obtained, histograms, misses. None before the servo's first status."""

    def head(self) -> int:
        """Ticks published so far; 0 while offline."""

    def read(self, since: int, limit: int) -> TickBatch:
        """At most ``limit`` ticks from ``since`` on. Empty while offline."""
