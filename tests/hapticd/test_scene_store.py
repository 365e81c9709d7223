"""Scenes on disk: they survive restarts, power failures and unreadable files."""

import json
from pathlib import Path
from typing import Any

import pytest

from hapticd.scene import Scene
from hapticd.scene_store import CorruptScene, SceneStore, StoredScene

WALL = {
    "id": "floor",
    "shape": {"type": "plane", "point_m": [0, 0], "normal": [0, 1]},
    "law": {"type": "motion", "eta": 0.0},
}
SCENE = Scene.model_validate({"walls": [WALL]})


@pytest.fixture
def store(tmp_path: Path) -> SceneStore:
    return SceneStore(tmp_path / "scenes", "hhd", dof=2)


def test_nothing_stored_is_an_empty_scene(store: SceneStore) -> None:
    assert store.load() == StoredScene(revision=0, scene=Scene())


def test_saved_scene_is_loaded_again(store: SceneStore) -> None:
    saved = StoredScene(revision=4, scene=SCENE)
    store.save(saved)
    assert store.load() == saved


def test_the_one_before_is_kept_beside_it(store: SceneStore, tmp_path: Path) -> None:
    store.save(StoredScene(revision=1, scene=SCENE))
    store.save(StoredScene(revision=2))
    previous = json.loads((tmp_path / "scenes" / "hhd.previous.json").read_text())
    assert previous["revision"] == 1
    assert store.load().revision == 2


def test_power_failure_while_writing_leaves_the_old_scene(
    store: SceneStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    store.save(StoredScene(revision=1, scene=SCENE))

    def cut(*_: Any) -> None:
        raise OSError("power failed")

    monkeypatch.setattr("hapticd.scene_store.os.fsync", cut)
    with pytest.raises(OSError, match="power failed"):
        store.save(StoredScene(revision=2))
    assert store.load() == StoredScene(revision=1, scene=SCENE)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b'{"revision": 3, "scene": {"wal',
        b"\xff\xfe",
        b'{"revision": 3, "scene": {"walls": [], "colour": 1}}',
        b'{"revision": -3}',
        json.dumps(
            {"revision": 3, "scene": {"walls": [WALL | {"law": {"type": "motion", "eta": 7}}]}}
        ).encode(),
    ],
)
def test_unreadable_file_is_moved_aside_and_the_scene_is_empty(
    store: SceneStore, tmp_path: Path, content: bytes
) -> None:
    store.save(StoredScene(revision=1))
    store.save(StoredScene(revision=2, scene=SCENE))
    (tmp_path / "scenes" / "hhd.json").write_bytes(content)
    with pytest.raises(CorruptScene) as caught:
        store.load()
    assert caught.value.moved_to.read_bytes() == content
    assert caught.value.stored.scene == Scene()
    # Above every revision that may have been given out, so that an old entity tag never fits by accident.
    assert caught.value.stored.revision > 2
    assert store.load() == caught.value.stored


def test_scene_of_another_dimension_is_moved_aside(tmp_path: Path) -> None:
    SceneStore(tmp_path, "hhd", dof=2).save(StoredScene(revision=1, scene=SCENE))
    with pytest.raises(CorruptScene, match="coordinates"):
        SceneStore(tmp_path, "hhd", dof=3).load()
