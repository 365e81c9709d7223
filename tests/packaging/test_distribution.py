"""What is shipped: every file that is read at run time is in the wheel, every source in the sdist."""

from __future__ import annotations

import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = {
    "hapticd": ROOT / "hapticd",
    "hapticd_api": ROOT / "api/hapticd_api",
    "hapticd_client": ROOT / "clients/python/hapticd_client",
    "hapticd_drivers": ROOT / "drivers/hapticd_drivers",
}
NOT_SHIPPED = {"core", "__pycache__", "README.md"}


def setuptools(*command: str) -> None:
    """Runs a setuptools command on the project, without the Rust build."""
    line = [sys.executable, "-c", "import setuptools; setuptools.setup()", "--quiet", *command]
    subprocess.run(line, cwd=ROOT, check=True, timeout=100, capture_output=True)


def sources(package: Path) -> set[Path]:
    """The files of a package that must be shipped, relative to it."""
    files = (path.relative_to(package) for path in package.rglob("*") if path.is_file())
    return {file for file in files if file.suffix != ".so" and not any(map(_stays_here, file.parts))}


def _stays_here(part: str) -> bool:
    return part in NOT_SHIPPED or part.startswith(".")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python part of the wheel, unpacked."""
    directory = tmp_path_factory.mktemp("wheel")
    setuptools("build_py", "--build-lib", str(directory))
    return directory


@pytest.mark.parametrize("name", PACKAGES)
def test_the_wheel_has_every_file_of_each_package_and_nothing_else(wheel: Path, name: str) -> None:
    shipped = {path.relative_to(wheel / name) for path in (wheel / name).rglob("*") if path.is_file()}
    assert shipped == sources(PACKAGES[name])


def test_the_sdist_can_build_the_core_and_names_its_licence(tmp_path: Path) -> None:
    setuptools("sdist", "--dist-dir", str(tmp_path))
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    core = {
        str(path.relative_to(ROOT))
        for pattern in ("*.rs", "Cargo.toml", "Cargo.lock")
        for path in (ROOT / "hapticd/core").rglob(pattern)
        if "target" not in path.parts
    }
    assert not core - names
    assert {"LICENSE", "README.md", "requirements.lock", "api/hapticd_api/page/index.html"} <= names


def test_the_lock_pins_every_requirement_by_hash_and_names_no_host() -> None:
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    requirements = [line for line in text.splitlines() if line and line[0] not in "# "]
    unpinned = [line for line in requirements if "==" not in line or not line.endswith("\\")]
    assert not unpinned
    assert text.count("--hash=sha256:") >= len(requirements)
    assert "://" not in text


def test_the_lock_covers_every_direct_requirement() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wanted = [*project["project"]["dependencies"], *project["dependency-groups"]["dev"]]
    names = {requirement.partition(">=")[0].lower() for requirement in wanted}
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    locked = {line.partition("==")[0] for line in text.splitlines() if line and line[0] not in "# "}
    assert not names - locked
