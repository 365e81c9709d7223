"""Default places: by the variables of the XDG specification, else in memory."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from hapticd import places


def test_the_runtime_directory_of_the_session_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/run/user/7")
    assert places.default_runtime_dir() == Path("/run/user/7/hapticd")


def test_without_a_session_shared_memory_lies_in_memory(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    monkeypatch.setattr(places, "MEMORY", tmp_path)
    assert places.default_runtime_dir() == tmp_path / f"hapticd-{os.getuid()}"


def test_without_memory_the_temporary_directory_serves(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    monkeypatch.setattr(places, "MEMORY", tmp_path / "none")
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path))
    assert places.default_runtime_dir() == tmp_path / f"hapticd-{os.getuid()}"
