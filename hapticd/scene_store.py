"""Scenes on disk: one JSON file per device, replaced atomically, with the one before it beside it."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from hapticd.problem import Problem
from hapticd.scene import Scene, check_scene


class StoredScene(BaseModel):
    """A scene, its revision and when it was saved."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    revision: int = Field(0, ge=0)
    saved_utc: datetime | None = None
    scene: Scene = Scene()


class CorruptScene(Exception):
    """The stored scene could not be used and was moved aside. ``stored`` is the empty one to go on with."""

    def __init__(self, why: str, moved_to: Path, stored: StoredScene) -> None:
        super().__init__(why)
        self.moved_to = moved_to
        self.stored = stored


class SceneStore:
    """The scene of one device under ``directory``. Blocking: call it off the event loop."""

    def __init__(self, directory: Path, device_id: str, dof: int) -> None:
        self._file = directory / f"{device_id}.json"
        self._previous = directory / f"{device_id}.previous.json"
        self._dof = dof

    def load(self) -> StoredScene:
        """The stored scene, or an empty one.

        ``CorruptScene`` when the file is of no use; it is moved aside.
        """
        if not self._file.exists():
            return StoredScene()
        try:
            return self._read(self._file)
        except (ValidationError, UnicodeDecodeError, Problem) as error:
            raise self._set_aside(error) from error

    def save(self, stored: StoredScene) -> None:
        """Replaces the file so that a power failure leaves either the old one or the new one. ``OSError``."""
        self._file.parent.mkdir(parents=True, exist_ok=True)
        fresh = self._file.with_suffix(".json.new")
        with fresh.open("w", encoding="utf-8") as file:
            file.write(stored.model_dump_json(indent=1))
            file.flush()
            os.fsync(file.fileno())
        self._keep_previous()
        fresh.replace(self._file)
        _sync_directory(self._file.parent)

    def _read(self, file: Path) -> StoredScene:
        stored = StoredScene.model_validate_json(file.read_text(encoding="utf-8"))
        check_scene(stored.scene, self._dof)
        return stored

    def _keep_previous(self) -> None:
        if self._file.exists():
            self._previous.unlink(missing_ok=True)
            os.link(self._file, self._previous)

    def _set_aside(self, error: Exception) -> CorruptScene:
        moved_to = self._file.with_name(f"{self._file.name}.corrupt-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")
        self._file.replace(moved_to)
        # The unreadable one had the number after the last good one; no number is used twice.
        empty = StoredScene(revision=self._last_good_revision() + 2)
        self.save(empty)
        return CorruptScene(str(error), moved_to, empty)

    def _last_good_revision(self) -> int:
        try:
            return self._read(self._previous).revision
        except (OSError, ValidationError, UnicodeDecodeError, Problem):
            return 0


def _sync_directory(directory: Path) -> None:
    descriptor = os.open(directory, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
