"""The client on a real server of the API: both must mean the same paths and documents."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, TypeVar

import pytest

from hapticd_client import (
    Client,
    Refused,
    box,
    capsule,
    cubic_damper,
    damper,
    friction,
    motion,
    open_stream,
    plane,
    sphere,
    spring,
)
from hapticd_client.documents import (
    Applied,
    Device,
    EstopReport,
    Event,
    Flags,
    Granted,
    Health,
    Interlock,
    Scene,
    SceneResult,
    StateReport,
    WallResult,
)
from hapticd_client.stream import Snapshot
from tests.api.conftest import address, rig

__all__ = ["address", "rig"]

FLOOR = plane("floor", point_m=[0.0, 0.0, -0.02], normal=[0.0, 0.0, 1.0])
Result = TypeVar("Result")


async def asked(address: str, act: Callable[[Client], Result]) -> Result:
    """What ``act`` returns, run beside the server's event loop."""

    def in_thread() -> Result:
        with Client(f"http://{address}") as client:
            return act(client)

    return await asyncio.to_thread(in_thread)


def lacking(document: Any, kind: Any) -> set[str]:
    """Members that the client's type promises and the daemon's document has not."""
    return set(kind.__required_keys__) - set(document)


async def test_a_device_has_what_the_client_promises(address: str) -> None:
    device = await asked(address, lambda client: client.device("phantom"))
    assert not lacking(device, Device)
    assert not lacking(device["flags"], Flags)
    assert not lacking(device["health"], Health)
    assert not lacking(device["interlocks"][0], Interlock)


async def test_all_devices_are_listed(address: str) -> None:
    devices = await asked(address, lambda client: client.devices())
    assert [device["id"] for device in devices] == ["phantom", "hhd", "bench"]


async def test_a_wall_is_made_read_and_taken_away(address: str) -> None:
    made = await asked(address, lambda client: client.put_wall("phantom", FLOOR, create_only=True))
    assert not lacking(made, WallResult)
    assert made["applied"] is not None
    assert not lacking(made["applied"], Applied)
    assert not lacking(made["granted"], Granted)
    assert [wall["shape"] for wall in await asked(address, lambda client: client.walls("phantom"))] == [
        FLOOR["shape"]
    ]
    gone = await asked(address, lambda client: client.delete_wall("phantom", "floor"))
    assert gone["wall"] is None
    assert await asked(address, lambda client: client.walls("phantom")) == []


async def test_walls_that_are_built_are_understood(address: str) -> None:
    turned = [0.5, 0.5, 0.5, 0.5]
    walls = [
        FLOOR,
        sphere("ball", center_m=[0.2, 0.0, 0.0], radius_m=0.02, law=spring(800, 2, passivity=True)),
        box("room", center_m=[0.2, 0.0, 0.0], size_m=[0.1, 0.1, 0.1], orientation=turned, hollow=True),
        capsule("rod", from_m=[0.2, 0.0, 0.0], to_m=[0.2, 0.1, 0.0], radius_m=0.01, law=damper(5)),
        plane("left", point_m=[0.0, 0.1, 0.0], normal=[0.0, -1.0, 0.0], law=motion(0.5, brake=None)),
    ]
    result = await asked(address, lambda client: client.replace_scene("phantom", {"walls": walls}))
    assert [wall["id"] for wall in result["walls"]] == ["floor", "ball", "room", "rod", "left"]
    tile = box(
        "tile",
        center_m=[0.0, 0.1],
        size_m=[0.1, 0.02],
        angle_rad=0.3,
        law=cubic_damper("explicit", brake=True),
        friction=friction(0.4, 0.3, "brake"),
    )
    made = await asked(address, lambda client: client.put_wall("hhd", tile, force=True))
    assert made["granted"] is not None
    assert made["granted"]["friction_actuator"] == "brake"


async def test_a_changed_wall_keeps_what_the_patch_does_not_name(address: str) -> None:
    await asked(address, lambda client: client.put_wall("phantom", FLOOR))
    softer = await asked(
        address, lambda client: client.change_wall("phantom", "floor", {"law": {"eta": 0.5}})
    )
    assert softer["wall"] is not None
    assert softer["wall"]["shape"] == FLOOR["shape"]


async def test_a_wall_that_must_be_new_replaces_none(address: str) -> None:
    await asked(address, lambda client: client.put_wall("phantom", FLOOR))
    with pytest.raises(Refused) as caught:
        await asked(address, lambda client: client.put_wall("phantom", FLOOR, create_only=True))
    assert caught.value.slug == "wall-exists"


async def test_a_dry_run_changes_nothing(address: str) -> None:
    result = await asked(address, lambda client: client.put_wall("phantom", FLOOR, dry_run=True))
    assert result["dry_run"]
    assert await asked(address, lambda client: client.walls("phantom")) == []


async def test_a_scene_edited_meanwhile_is_not_overwritten(address: str) -> None:
    scene, etag = await asked(address, lambda client: client.scene("phantom"))
    assert not lacking(scene, Scene)
    result = await asked(address, lambda client: client.replace_scene("phantom", scene, etag=etag))
    assert not lacking(result, SceneResult)
    await asked(address, lambda client: client.put_wall("phantom", FLOOR))
    with pytest.raises(Refused) as caught:
        await asked(address, lambda client: client.replace_scene("phantom", scene, etag=etag))
    assert caught.value.slug == "revision-stale"


async def test_states_are_changed_and_refused_with_the_open_interlocks(address: str) -> None:
    report = await asked(address, lambda client: client.enable("phantom"))
    assert not lacking(report, StateReport)
    assert report["state"] == "enabled"
    await asked(address, lambda client: client.disable("phantom"))
    with pytest.raises(Refused) as caught:
        await asked(address, lambda client: client.enable("bench"))
    assert caught.value.status == 409


async def test_estops_latch_for_one_device_and_for_all(address: str) -> None:
    one = await asked(address, lambda client: client.engage_estop("phantom"))
    assert not lacking(one, EstopReport)
    assert one["engaged"]
    await asked(address, lambda client: client.acknowledge_estop("phantom"))
    every = await asked(address, lambda client: client.engage_all_estops())
    assert {report["device_id"] for report in every if report["engaged"]} >= {"phantom", "hhd"}
    cleared = await asked(address, lambda client: client.acknowledge_all_estops())
    assert not any(report["engaged"] for report in cleared if report["device_id"] != "bench")


async def test_a_fault_that_is_not_latched_cannot_be_acknowledged(address: str) -> None:
    with pytest.raises(Refused) as caught:
        await asked(address, lambda client: client.acknowledge_fault("phantom", "encoder-jump"))
    assert caught.value.slug == "fault-not-found"


async def test_the_hand_takes_a_script(address: str) -> None:
    script = {"type": "push", "direction": [0, 0, -1], "force_n": 1.0}
    report = await asked(address, lambda client: client.set_hand("phantom", script))
    assert report["hand"]["force_n"] == 1.0


async def test_events_tell_what_was_done(address: str) -> None:
    await asked(address, lambda client: client.put_wall("phantom", FLOOR))
    events = await asked(address, lambda client: client.events())
    assert not lacking(events[-1], Event)
    assert "scene.changed" in {event["kind"] for event in events}


async def test_the_realtime_report_is_there(address: str) -> None:
    assert "devices" in await asked(address, lambda client: client.realtime())


async def test_the_stream_opens_and_shows_the_device_subscribed_to(address: str) -> None:
    def first() -> Any:
        with open_stream(f"http://{address}") as stream:
            stream.subscribe("phantom", ["tip_position_m"], mode="batch")
            return next(iter(stream))

    message = await asyncio.to_thread(first)
    assert isinstance(message, Snapshot)
    assert not lacking(message.device, Device)


async def test_the_stream_refuses_a_signal_that_does_not_exist(address: str) -> None:
    def subscribe() -> None:
        with open_stream(f"http://{address}") as stream:
            stream.subscribe("phantom", ["tip_farce_n"])

    with pytest.raises(Refused) as caught:
        await asyncio.to_thread(subscribe)
    assert caught.value.slug == "signal-unknown"
