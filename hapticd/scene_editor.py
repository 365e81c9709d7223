"""Edits of one device's scene: checked, sent to the loop, acknowledged, written to disk, told."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from datetime import UTC, datetime
from typing import Any

from hapticd.admission import Admission
from hapticd.analysis.device_stability import DeviceStability
from hapticd.edit_terms import Terms
from hapticd.events import EventLog
from hapticd.flat_scene import edit_fade_s, flatten
from hapticd.model import Model
from hapticd.problem import Problem
from hapticd.scene import Scene, check_scene
from hapticd.scene_admission import AdmittedScene, admit_scene
from hapticd.scene_result import GrantedWall, SceneResult
from hapticd.scene_store import CorruptScene, SceneStore, StoredScene
from hapticd.snapshot import Applied
from hapticd.wall import Wall, check_brakes, check_wall

Send = Callable[[Mapping[str, Any], float], Awaitable[Applied | None]]
"""Sends a flat scene with its fade time. None when no loop is there to take it."""

Grant = Callable[[Scene, Mapping[str, Admission]], list[GrantedWall]]
"""Says what the walls of a scene come to, with the admissions of those that were looked at."""

OFFLINE_NOTE = "The device is offline: the scene is kept on disk and goes into force when the device is back."
DRY_RUN_NOTE = "Nothing was changed: this was a dry run."


class SceneEditor:
    """One device's scene and its revisions. Edits come one after the other, each whole or not at all."""

    def __init__(
        self,
        device_id: str,
        model: Model,
        store: SceneStore,
        events: EventLog,
        *,
        send: Send,
        stability: DeviceStability,
        grant: Grant,
    ) -> None:
        self._device_id = device_id
        self._dof = model.dof
        self._brakes = model.has_brakes
        self._store = store
        self._events = events
        self._send = send
        self._stability = stability
        self._grant = grant
        self._stored = self._load()
        self._last_revision = self._stored.revision
        self._editing = asyncio.Lock()
        self._edits: set[asyncio.Task[SceneResult]] = set()
        self._wall_ids = _wall_ids(self._stored.scene)
        self._lent_to: str | None = None

    @property
    def scene(self) -> Scene:
        return self._stored.scene

    @property
    def revision(self) -> int:
        return self._stored.revision

    @property
    def etag(self) -> str:
        """The strong entity tag of the scene: its revision, quoted."""
        return f'"{self.revision}"'

    def wall_id(self, index: int) -> str | None:
        """Id of the wall at this place of the flat scene of the present revision."""
        return self._wall_ids[index] if 0 <= index < len(self._wall_ids) else None

    async def replace(self, scene: Scene, terms: Terms) -> SceneResult:
        """Puts another scene in the place of this one."""
        return await self.edit(lambda _: scene, terms)

    async def put_wall(self, wall: Wall, terms: Terms, *, create_only: bool) -> SceneResult:
        """Adds a wall, or replaces the one of this id unless ``create_only``."""
        self._check_wall(wall)

        def put(scene: Scene) -> Scene:
            if create_only and scene.wall(wall.id) is not None:
                raise Problem(
                    "wall-exists", f"{self._device_id} has a wall {wall.id!r}.", device_id=self._device_id
                )
            return scene.with_wall(wall)

        return await self.edit(put, terms, about=wall.id)

    async def change_wall(self, wall_id: str, change: Callable[[Wall], Wall], terms: Terms) -> SceneResult:
        """Puts what ``change`` makes of a wall in its place; no other edit comes between."""

        def changed(scene: Scene) -> Scene:
            wall = change(self.wall(wall_id))
            self._check_wall(wall)
            return scene.with_wall(wall)

        return await self.edit(changed, terms, about=wall_id)

    async def delete_wall(self, wall_id: str, terms: Terms) -> SceneResult:
        """Takes a wall away."""

        def delete(scene: Scene) -> Scene:
            self.wall(wall_id)
            return scene.without_wall(wall_id)

        return await self.edit(delete, terms)

    def wall(self, wall_id: str) -> Wall:
        """The wall of this id. ``Problem`` (wall-not-found) lists those there are."""
        found = self.scene.wall(wall_id)
        if found is None:
            ids = [wall.id for wall in self.scene.walls]
            detail = f"The scene of {self._device_id} has no wall {wall_id!r}."
            raise Problem("wall-not-found", detail, device_id=self._device_id, allowed=ids)
        return found

    async def edit(
        self, change: Callable[[Scene], Scene], terms: Terms, *, about: str | None = None
    ) -> SceneResult:
        """Replaces the scene by what ``change`` makes of it.

        Order: check, admit, send, acknowledge, disk, event. Once begun it is finished, also when the caller
        goes away, so that loop and disk agree. ``about`` is the id of the wall that is the caller's whole
        document. Raises ``Problem``.
        """
        edit = asyncio.create_task(self._edit(change, terms, about))
        self._edits.add(edit)
        edit.add_done_callback(self._edits.discard)
        return await asyncio.shield(edit)

    async def send_present(self, needed: Callable[[], bool], fade_s: float = 0.0) -> None:
        """Puts the present scene in force in a loop that does not have it. Raises ``Problem``.

        ``needed`` is asked between edits: an edit on its way looks like a loop that renders something else.
        """
        async with self._editing:
            if self._lent_to is None and needed():
                flat, _ = flatten(self.scene, self.revision, fade_s)
                await self._send(flat, fade_s)

    @property
    def is_lent(self) -> bool:
        """Whether somebody else says for now what the loop renders."""
        return self._lent_to is not None

    async def lend(self, to: str) -> None:
        """Refuses edits until ``take_back``. ``Problem`` (device-lent) while it is lent already."""
        async with self._editing:
            self.check_not_lent()
            self._lent_to = to

    def take_back(self) -> None:
        """Takes edits again; ``send_present`` then puts the scene in force."""
        self._lent_to = None

    def next_revision(self) -> int:
        """A revision that no scene of this device has had."""
        self._last_revision += 1
        return self._last_revision

    def check_not_lent(self) -> None:
        """``Problem`` (device-lent) while it is lent."""
        if self._lent_to is not None:
            detail = f"{self._device_id} is lent to {self._lent_to}."
            raise Problem("device-lent", detail, device_id=self._device_id)

    async def _edit(self, change: Callable[[Scene], Scene], terms: Terms, about: str | None) -> SceneResult:
        async with self._editing:
            self._check_match(terms.if_match)
            admitted = await self._admitted(change(self.scene), terms, about)
            after = admitted.scene
            applied = None
            if not terms.dry_run:
                self.check_not_lent()
                applied = await self._put_in_force(after)
            return SceneResult(
                scene=after,
                etag=self.etag,
                revision=self.revision,
                applied=applied,
                dry_run=terms.dry_run,
                note=_note(terms, applied),
                walls=self._grant(after, admitted.admissions),
            )

    async def _admitted(self, after: Scene, terms: Terms, about: str | None) -> AdmittedScene:
        check_scene(after, self._dof, brakes=self._brakes)
        # Some milliseconds a wall: the event loop goes on meanwhile.
        return await asyncio.to_thread(
            admit_scene, self._stability, self.scene, after, force=terms.force, about=about
        )

    async def _put_in_force(self, after: Scene) -> Applied | None:
        # A number is never used twice, not even after an edit that failed: it may have reached the loop.
        revision = self.next_revision()
        fade_s = edit_fade_s(self.scene, after)
        flat, wall_ids = flatten(after, revision, fade_s)
        applied = await self._send(flat, fade_s)
        self._stored = StoredScene(revision=revision, saved_utc=datetime.now(UTC), scene=after)
        self._wall_ids = wall_ids
        await self._save()
        self._tell(applied)
        return applied

    def _check_wall(self, wall: Wall) -> None:
        check_wall(wall, self._dof)
        if not self._brakes:
            check_brakes(wall)

    def _check_match(self, if_match: str | None) -> None:
        if if_match is None or if_match.strip() == "*":
            return
        if self.etag not in (tag.strip() for tag in if_match.split(",")):
            detail = f"If-Match is {if_match}, the scene of {self._device_id} is at {self.etag}."
            raise Problem("revision-stale", detail, device_id=self._device_id)

    async def _save(self) -> None:
        try:
            await asyncio.to_thread(self._store.save, self._stored)
        except OSError as error:
            detail = f"The scene of {self._device_id}, revision {self.revision}, was not saved: {error}."
            self._events.append("scene.not_saved", detail, device_id=self._device_id)
            raise Problem("storage-failed", detail, device_id=self._device_id) from error

    def _tell(self, applied: Applied | None) -> None:
        self._events.append(
            "scene.changed",
            f"{self._device_id} has scene revision {self.revision} with {len(self.scene.walls)} walls.",
            device_id=self._device_id,
            tick=None if applied is None else applied.tick,
            t_mono_ns=None if applied is None else applied.t_mono_ns,
            details={"revision": self.revision, "walls": [wall.id for wall in self.scene.walls]},
        )

    def _load(self) -> StoredScene:
        try:
            return self._store.load()
        except CorruptScene as error:
            message = f"The stored scene of {self._device_id} is of no use; its scene is empty now."
            aside = {"moved_to": str(error.moved_to), "why": str(error)}
            self._events.append("scene.corrupt", message, device_id=self._device_id, details=aside)
            return error.stored


def _note(terms: Terms, applied: Applied | None) -> str | None:
    if terms.dry_run:
        return DRY_RUN_NOTE
    return OFFLINE_NOTE if applied is None else None


def _wall_ids(scene: Scene) -> list[str]:
    return [wall.id for wall in scene.walls if wall.enabled]
