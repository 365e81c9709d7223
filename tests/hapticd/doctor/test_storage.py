"""Directories: what can be used, and on which file system shared memory would lie."""

from __future__ import annotations

from pathlib import Path

import pytest

from hapticd.doctor import Verdict, storage
from tests.hapticd.doctor.conftest import MakeConfig

MOUNTS = """\
/dev/vda / ext4 rw 0 0
tmpfs /run tmpfs rw 0 0
/dev/sdb /run/user/1000/my\\040disk xfs rw 0 0
tmpfs /srv tmpfs rw 0 0
/dev/sdc /srv btrfs rw 0 0
"""


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/home/someone", "ext4"),
        ("/run/hapticd", "tmpfs"),
        ("/run", "tmpfs"),
        ("/runway", "ext4"),
        ("/run/user/1000/my disk/hapticd", "xfs"),
        ("/srv/x", "btrfs"),
    ],
)
def test_the_deepest_and_last_mount_wins(path: str, kind: str) -> None:
    assert storage.file_system_of(Path(path), MOUNTS) == kind


def test_directories_that_can_be_made_are_no_fault_and_are_not_made(
    make_config: MakeConfig, tmp_path: Path
) -> None:
    findings = list(storage.examine(make_config()))
    assert Verdict.FAIL not in {finding.verdict for finding in findings}
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_the_place_of_a_directory_fails(make_config: MakeConfig, tmp_path: Path) -> None:
    (tmp_path / "state").write_text("in the way")
    first = next(iter(storage.examine(make_config())))
    assert first.verdict is Verdict.FAIL
    assert str(tmp_path / "state") in first.detail


def test_a_directory_without_write_permission_fails(
    make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Root may write everywhere, so the answer of the system is given.
    monkeypatch.setattr("os.access", lambda *_: False)
    first = next(iter(storage.examine(make_config())))
    assert first.verdict is Verdict.FAIL
    assert first.cure is not None
    assert first.cure.startswith("sudo install -d")


def test_a_full_disk_is_warned_of(make_config: MakeConfig, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(storage, "FREE_MIN_BYTES", 1 << 62)
    assert next(iter(storage.examine(make_config()))).verdict is Verdict.WARN


def test_shared_memory_on_a_disk_is_warned_of(
    make_config: MakeConfig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mounts = tmp_path / "mounts"
    monkeypatch.setattr(storage, "MOUNTS", mounts)
    verdicts = []
    for kind in ("ext4", "tmpfs"):
        mounts.write_text(f"x / {kind} rw 0 0\n")
        verdicts.append(list(storage.examine(make_config()))[-1].verdict)
    assert verdicts == [Verdict.WARN, Verdict.OK]
