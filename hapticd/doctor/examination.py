"""The whole examination, from the build to the configured devices."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from hapticd.config import Config, load_config
from hapticd.doctor import address, build, driver, realtime, serial_port, stability, storage
from hapticd.doctor.finding import Finding, fail, ok
from hapticd.problem import Problem


def examine(config_file: Path | None = None) -> Iterator[Finding]:
    """Findings in the order a person would mend them; a broken configuration ends the list early."""
    yield from build.examine()
    try:
        config = load_config(config_file)
    except Problem as problem:
        yield fail("configuration", problem.detail, problem.hint)
        return
    yield ok("configuration", _summary(config))
    yield from driver.examine(config)
    yield from serial_port.examine(config)
    yield from storage.examine(config)
    yield from address.examine(config)
    yield from realtime.examine(config)
    yield from stability.examine(config)


def _summary(config: Config) -> str:
    devices = ", ".join(f"{device.id} ({device.model} by {device.driver})" for device in config.devices)
    return f"Devices: {devices}."
