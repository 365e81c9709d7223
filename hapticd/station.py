"""The station: every device, its supervisor and its telemetry, started and stopped as one."""

from __future__ import annotations

from collections.abc import Mapping

from hapticd.config import Config
from hapticd.device import Device
from hapticd.events import EventLog
from hapticd.telemetry import Telemetry


class Station:
    """Everything the daemon runs. The API is built over this."""

    def __init__(self, config: Config) -> None:
        self.config = config
        self.boot_id: str
        self.events: EventLog
        self.devices: Mapping[str, Device]
        self.telemetry: Mapping[str, Telemetry]

    def device(self, device_id: str) -> Device:
        """The device of this id. ``Problem``: device-not-found."""

    async def start(self) -> None:
        """Starts or attaches to every servo. Returns at once: devices are offline until their servo is there."""

    async def stop(self) -> None:
        """Fades forces out, stops every servo; bounded."""

    def ready(self) -> list[str]:
        """What keeps the daemon from being ready, as sentences; empty when it is."""
