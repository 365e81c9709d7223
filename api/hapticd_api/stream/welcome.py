"""The first message of the daemon: what there is to see, and in which words."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from hapticd.signals import signals
from hapticd.station import Station
from hapticd_api.release import release
from hapticd_api.stream.clock import clock_map
from hapticd_api.stream.message import PROTOCOL_VERSION


def welcome(station: Station) -> dict[str, Any]:
    """Versions, clocks, devices, and every signal with its unit and shape."""
    return {
        "type": "welcome",
        "version": PROTOCOL_VERSION,
        "daemon": {"version": release(), "boot_id": station.boot_id},
        "clock": clock_map(),
        "devices": [
            {"id": device.device_id, "model": device.model_name, "dof": device.dof, "rate_hz": device.rate_hz}
            for device in station.devices.values()
        ],
        "signals": [asdict(signal) for signal in signals().values()],
    }
