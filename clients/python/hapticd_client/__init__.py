"""Python client of hapticd: configure walls, drive the state of devices, watch every tick.

It depends on nothing of the daemon and talks to it over HTTP and WebSocket alone.
"""

from hapticd_client.client import Client, VersionedScene
from hapticd_client.documents import Device, Scene
from hapticd_client.error import HapticdError, NotHapticd, Refused, StreamClosed, Unreachable
from hapticd_client.stream import Stream, open_stream
from hapticd_client.walls import (
    Wall,
    box,
    capsule,
    cubic_damper,
    damper,
    friction,
    motion,
    plane,
    sphere,
    spring,
)

__all__ = [
    "Client",
    "Device",
    "HapticdError",
    "NotHapticd",
    "Refused",
    "Scene",
    "Stream",
    "StreamClosed",
    "Unreachable",
    "VersionedScene",
    "Wall",
    "box",
    "capsule",
    "cubic_damper",
    "damper",
    "friction",
    "motion",
    "open_stream",
    "plane",
    "sphere",
    "spring",
]
