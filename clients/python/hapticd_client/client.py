"""The client: one method for each thing a daemon can be asked for.

with Client() as daemon:
    daemon.put_wall("phantom", plane("floor", point_m=[0, 0, -0.02], normal=[0, 0, 1]))
    daemon.enable("phantom")
"""

from __future__ import annotations

from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple, Self

import httpx

from hapticd_client.connection import Connection, Reply, daemon_url
from hapticd_client.documents import (
    Desired,
    Device,
    EstopReport,
    Event,
    Fault,
    Scene,
    SceneResult,
    StateReport,
    WallResult,
)
from hapticd_client.walls import Wall

API = ("api", "v1")


class VersionedScene(NamedTuple):
    """A scene and the entity tag of its revision, to be sent back with an edit."""

    scene: Scene
    etag: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Edit:
    """The conditions of an edit."""

    etag: str | None
    dry_run: bool
    create_only: bool = False
    force: bool = False

    def headers(self) -> dict[str, str]:
        """The preconditions of RFC 9110."""
        headers = {"If-Match": self.etag} if self.etag else {}
        return headers | {"If-None-Match": "*"} if self.create_only else headers

    def query(self) -> dict[str, str]:
        """The query parameters."""
        asked = {"dry_run": self.dry_run, "force": self.force}
        return {name: "true" for name, wanted in asked.items() if wanted}


class Client:
    """Talks to the daemon at ``url``, by default ``$HAPTICD_URL`` or ``http://127.0.0.1:8420``.

    Every method raises `Refused` with the daemon's problem document, or `Unreachable`. An edit that is given
    an ``etag`` is refused (revision-stale) when somebody else has edited since; ``dry_run`` validates and
    changes nothing; ``force`` lets walls in over their stability budget, with passivity.
    """

    def __init__(
        self, url: str | None = None, *, timeout_s: float = 5.0, transport: httpx.BaseTransport | None = None
    ) -> None:
        self._connection = Connection(daemon_url(url), timeout_s, transport)

    @property
    def url(self) -> str:
        """The daemon's address."""
        return self._connection.url

    def close(self) -> None:
        """Closes the connection."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def devices(self) -> list[Device]:
        """All devices, in the order of the daemon's configuration."""
        devices: list[Device] = self._get("devices")["devices"]
        return devices

    def device(self, device_id: str) -> Device:
        """One device."""
        device: Device = self._get("devices", device_id)
        return device

    def set_state(self, device_id: str, desired: Desired) -> StateReport:
        """Asks for a state. Forces ramp up when enabled, fade out otherwise."""
        report: StateReport = self._put({"desired": desired}, "devices", device_id, "state")
        return report

    def enable(self, device_id: str) -> StateReport:
        """Lets the device render forces. `Refused` (interlock-open) says what keeps it from it."""
        return self.set_state(device_id, "enabled")

    def disable(self, device_id: str) -> StateReport:
        """Fades forces out."""
        return self.set_state(device_id, "disabled")

    def engage_estop(self, device_id: str) -> EstopReport:
        """Stops a device now and latches it."""
        report: EstopReport = self._put(None, "devices", device_id, "estop")
        return report

    def acknowledge_estop(self, device_id: str) -> EstopReport:
        """Clears the latch; the device stays disabled."""
        report: EstopReport = self._send("DELETE", "devices", device_id, "estop").document
        return report

    def engage_all_estops(self) -> list[EstopReport]:
        """Stops every device now and latches them."""
        reports: list[EstopReport] = self._put(None, "estop")["devices"]
        return reports

    def acknowledge_all_estops(self) -> list[EstopReport]:
        """Clears every latch; the devices stay disabled."""
        reports: list[EstopReport] = self._send("DELETE", "estop").document["devices"]
        return reports

    def faults(self, device_id: str) -> list[Fault]:
        """The latched faults of a device."""
        return self.device(device_id)["faults"]

    def acknowledge_fault(self, device_id: str, fault_id: str) -> None:
        """Clears a latched fault whose cause is gone."""
        self._send("DELETE", "devices", device_id, "faults", fault_id)

    def scene(self, device_id: str) -> VersionedScene:
        """The scene of a device, with its entity tag."""
        reply = self._send("GET", "devices", device_id, "scene")
        return VersionedScene(reply.document, reply.etag)

    def replace_scene(
        self,
        device_id: str,
        scene: Scene,
        *,
        etag: str | None = None,
        dry_run: bool = False,
        force: bool = False,
    ) -> SceneResult:
        """Puts another scene in force, whole, at one tick."""
        edit = Edit(etag=etag, dry_run=dry_run, force=force)
        result: SceneResult = self._edit("PUT", (device_id, "scene"), scene, edit)
        return result

    def walls(self, device_id: str) -> list[Wall]:
        """The walls of a device, in their order."""
        return self.scene(device_id).scene["walls"]

    def put_wall(
        self,
        device_id: str,
        wall: Wall,
        *,
        create_only: bool = False,
        etag: str | None = None,
        dry_run: bool = False,
        force: bool = False,
    ) -> WallResult:
        """Adds a wall, or replaces its namesake unless ``create_only``."""
        edit = Edit(create_only=create_only, etag=etag, dry_run=dry_run, force=force)
        result: WallResult = self._edit("PUT", (device_id, "scene", "walls", wall["id"]), wall, edit)
        return result

    def change_wall(
        self,
        device_id: str,
        wall_id: str,
        patch: dict[str, Any],
        *,
        etag: str | None = None,
        dry_run: bool = False,
        force: bool = False,
    ) -> WallResult:
        """Merges a patch into a wall, as ``{"law": {"eta": 0.5}}``; a law whose type changes is replaced."""
        edit = Edit(etag=etag, dry_run=dry_run, force=force)
        result: WallResult = self._edit("PATCH", (device_id, "scene", "walls", wall_id), patch, edit)
        return result

    def delete_wall(
        self, device_id: str, wall_id: str, *, etag: str | None = None, dry_run: bool = False
    ) -> WallResult:
        """Takes a wall away; its force fades out."""
        edit = Edit(etag=etag, dry_run=dry_run)
        result: WallResult = self._edit("DELETE", (device_id, "scene", "walls", wall_id), None, edit)
        return result

    def set_hand(self, device_id: str, script: dict[str, Any]) -> dict[str, Any]:
        """Tells a twin's hand what to do, as ``{"type": "push", "direction": [0, 0, -1], "force_n": 2}``."""
        report: dict[str, Any] = self._put(script, "devices", device_id, "twin", "hand")
        return report

    def events(self, after: int = 0, limit: int = 100) -> list[Event]:
        """What happened after the event of id ``after``, oldest first."""
        page = self._send("GET", "events", query={"after": after, "limit": limit}).document
        events: list[Event] = page["events"]
        return events

    def realtime(self) -> dict[str, Any]:
        """Scheduling really obtained, histograms and misses."""
        report: dict[str, Any] = self._get("system", "realtime")
        return report

    def _get(self, *path: str) -> Any:
        return self._send("GET", *path).document

    def _put(self, body: object, *path: str) -> Any:
        return self._send("PUT", *path, body=body).document

    def _edit(self, method: str, path: tuple[str, ...], body: object, edit: Edit) -> Any:
        return self._send(
            method, "devices", *path, body=body, query=edit.query(), headers=edit.headers()
        ).document

    def _send(self, method: str, *path: str, **parts: Any) -> Reply:
        return self._connection.send(method, *API, *path, **parts)
