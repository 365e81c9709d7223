"""The servo process: ``python -m hapticd.servo CONFIG.json`` runs one device's real-time loop.

The configuration is one JSON object::

    device_id       the device's id
    device_model    the model, as ``Model.device_json`` holds it
    twin_model      the twin's plant, as ``Model.twin_json`` holds it; null for a device with a driver
    driver          "twin", or the name of an entry point in the group ``hapticd.drivers``
    options         what the driver is created with; ``rate_hz`` is added where it is not given
    rate_hz         rate of the loop, Hz
    region          file of the shared memory
    realtime        "off", "preferred" or "required"
    priority        SCHED_FIFO priority, 1 to 99 (80)
    cpu             CPU to stay on, or null
    seed            seed of the twin's noise
    orphan_exit_s   without a front for this long the process ends, s (10); null: never

SIGTERM and SIGINT fade the outputs to zero and end the process within 2 s. Exit codes: 0 ended as asked, or
for want of a front; 1 the loop failed; 2 the configuration cannot be used.
"""

from __future__ import annotations

import argparse
import gc
import json
import logging
import signal
import sys
from collections.abc import Mapping
from importlib.metadata import entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hapticd import _core
from hapticd.link import Link
from hapticd.model import Model

if TYPE_CHECKING:
    from hapticd._core import Driver

DRIVER_GROUP = "hapticd.drivers"
TWIN = "twin"

EXIT_FAILED = 1
EXIT_CONFIG = 2

log = logging.getLogger(__name__)


class ConfigError(Exception):
    """The configuration cannot be used; the text names the key."""


def read_config(path: Path) -> dict[str, Any]:
    """The configuration in a file. ``ConfigError`` when there is none, or it is no JSON object."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ConfigError(f"{path}: {error}") from error
    if not isinstance(document, dict):
        raise ConfigError(f"{path}: not a JSON object")
    return document


def create_driver(document: Mapping[str, Any]) -> Driver | None:
    """The driver the configuration names; None for the twin. ``ConfigError`` when it cannot be made."""
    name = document.get("driver", TWIN)
    if name == TWIN:
        return None
    found = next(iter(entry_points(group=DRIVER_GROUP, name=name)), None)
    if found is None:
        known = ", ".join(sorted({TWIN, *entry_points(group=DRIVER_GROUP).names}))
        raise ConfigError(f"driver: there is no {name!r}. Drivers: {known}")
    try:
        options = {"rate_hz": document["rate_hz"], **document.get("options", {})}
        driver: Driver = found.load().create(options, _model(document))
    except Exception as error:
        # A driver is somebody else's code: what it raises while it is made is about its options or its
        # requirements, and the caller prints it.
        raise ConfigError(f"driver {name!r}: {type(error).__name__}: {error}") from error
    return driver


def _model(document: Mapping[str, Any]) -> Model:
    try:
        device = document["device_model"]
        return Model(
            device["name"], device["dof"], json.dumps(device), json.dumps(document.get("twin_model"))
        )
    except (KeyError, TypeError) as error:
        raise ConfigError(f"device_model: {error!r}") from error


def run(document: Mapping[str, Any]) -> int:
    """Runs the loop of one device to its end and returns the process's exit code. Main thread only."""
    driver = create_driver(document)
    core_document = {key: value for key, value in document.items() if key not in ("driver", "options")}
    try:
        servo = _core.Servo(json.dumps(core_document), driver)
    except (ValueError, OSError, _core.RegionError) as error:
        raise ConfigError(str(error)) from error
    link = Link(driver) if driver is not None else None
    _stop_on_signals(servo, link)
    _freeze_garbage()
    servo.start()
    try:
        return _park(servo, link)
    finally:
        if link is not None:
            link.close()


def _park(servo: _core.Servo, link: Link | None) -> int:
    """Waits for the loop, reconnecting the driver whenever it is down."""
    while (outcome := servo.wait()) == "down":
        if error := servo.driver_error():
            log.warning("the device was lost: %s", error)
        if link is not None and link.connect():
            servo.driver_ready()
    log.info("the loop ended: %s", outcome)
    if outcome.startswith("failed"):
        log.error(outcome)
        return EXIT_FAILED
    return 0


def _stop_on_signals(servo: _core.Servo, link: Link | None) -> None:
    def stop(_signal: int, _frame: object) -> None:
        servo.request_stop()
        if link is not None:
            link.give_up()

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    signal.set_wakeup_fd(servo.wake_fd(), warn_on_full_buffer=False)


def _freeze_garbage() -> None:
    """No collection ever runs in the real-time thread: what lives now lives on, the rest is counted."""
    gc.collect()
    gc.freeze()
    gc.disable()


def main(arguments: list[str] | None = None) -> int:
    """The process."""
    parser = argparse.ArgumentParser(prog="hapticd.servo", description="One device's real-time loop.")
    parser.add_argument("config", type=Path, help="the configuration, a JSON file")
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
    try:
        return run(read_config(options.config))
    except ConfigError as error:
        print(f"hapticd.servo: {error}", file=sys.stderr)
        return EXIT_CONFIG


if __name__ == "__main__":
    sys.exit(main())
