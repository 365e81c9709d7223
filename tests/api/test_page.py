"""The live page: its arithmetic under Node, and its words against the daemon's."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

from hapticd.reading import FLAGS, STATES
from hapticd.signals import signals
from hapticd_api import page_files

TESTS = Path(__file__).parent / "page"
PAGE = Path(page_files.__file__).parent / "page"
TIMEOUT_S = 120


def node(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs Node, which the page's tests need as the Rust core's need cargo."""
    executable = shutil.which("node")
    assert executable is not None, "Node is not installed: apt install nodejs"
    return subprocess.run(
        [executable, *arguments], capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )


def test_arithmetic_of_the_page_is_right() -> None:
    outcome = node("--test", str(TESTS / "page.test.mjs"))
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


def test_page_subscribes_to_signals_that_exist() -> None:
    outcome = node(str(TESTS / "signals.mjs"))
    assert outcome.returncode == 0, outcome.stderr
    assert set(json.loads(outcome.stdout)) <= set(signals())


def test_page_knows_states_and_flags_as_the_record_has_them() -> None:
    panel = (PAGE / "device_panel.js").read_text(encoding="utf-8")
    states = re.search(r"const STATES = (\[.*?\]);", panel)
    contact = re.search(r"const CONTACT_FLAG = (\d+);", panel)
    assert states is not None
    assert contact is not None
    assert tuple(json.loads(states[1])) == STATES
    assert int(contact[1]) == 1 << FLAGS.index("contact")


def test_every_part_a_script_names_is_in_the_page() -> None:
    html = (PAGE / "index.html").read_text(encoding="utf-8")
    ids = set(re.findall(r'id="([a-z-]+)"', html))
    scripts = "".join(path.read_text(encoding="utf-8") for path in PAGE.glob("*.js"))
    named = set(re.findall(r'(?:byId|getElementById|copyOf)\("([a-z-]+)"\)', scripts))
    assert named
    assert named <= ids


def test_every_module_a_script_imports_is_there() -> None:
    for path in PAGE.glob("*.js"):
        for name in re.findall(r'from "\./([^"]+)"', path.read_text(encoding="utf-8")):
            assert (PAGE / name).exists(), f"{path.name} imports {name}"
