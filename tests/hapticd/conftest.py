"""A device with its parts, and a link that plays its servo."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from hapticd.config import DeviceConfig
from hapticd.device import Device
from hapticd.events import EventLog
from hapticd.model import load_model
from hapticd.scene_store import SceneStore
from hapticd.wall import Wall
from tests.hapticd.fake_link import FakeLink


class Bench:
    """One device on a bench: its files, its events, and the link to a servo that is not there."""

    def __init__(self, state_dir: Path, driver: str = "twin") -> None:
        self.state_dir = state_dir
        self.events = EventLog(state_dir)
        self.store = SceneStore(state_dir, "phantom", dof=3)
        config = DeviceConfig(id="phantom", model="phantom-1.0", driver=driver)
        self.device = Device(config, load_model("phantom-1.0"), self.store, self.events)
        self.link = FakeLink()

    async def attach(self) -> None:
        """Attaches the device as the supervisor does."""
        self.link.run()
        self.device.attach(self.link)
        await self.device.restore()
        self.link.requests.clear()
        self.link.asked.clear()

    async def sent(self) -> None:
        """Waits until a request has gone to the servo."""
        await asyncio.wait_for(self.link.asked.wait(), 10.0)

    def stored(self) -> dict[str, Any]:
        """The scene file."""
        document: dict[str, Any] = json.loads((self.state_dir / "phantom.json").read_text())
        return document

    def kinds(self) -> list[str]:
        """Kinds of the events so far."""
        return [event.kind for event in self.events.after()]


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.device.detach("The test is over.")


@pytest.fixture
def floor() -> Wall:
    return make_wall("floor")


def make_wall(wall_id: str, eta: float = 0.0, **changes: Any) -> Wall:
    """A wall under a three-dimensional device."""
    return Wall.model_validate(
        {
            "id": wall_id,
            "shape": {"type": "plane", "point_m": [0, 0, -0.02], "normal": [0, 0, 1]},
            "law": {"type": "motion", "eta": eta},
            **changes,
        }
    )


async def settle() -> None:
    """Lets every task that is ready run."""
    for _ in range(5):
        await asyncio.sleep(0)
