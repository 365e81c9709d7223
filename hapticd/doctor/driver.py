"""Models and drivers: whether every configured device has both."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import EntryPoint, entry_points

from hapticd.config import TWIN_DRIVER, Config, DeviceConfig
from hapticd.doctor.finding import Finding, fail, ok, warn

GROUP = "hapticd.drivers"
REINSTALL = "Reinstall the package that it comes from, or remove it."


def examine(config: Config) -> Iterator[Finding]:
    """Each configured device's model and driver, and drivers that are installed but broken."""
    broken = {}
    for entry in entry_points(group=GROUP):
        error = _import_error(entry)
        if error is not None:
            broken[entry.name] = error
    for device in config.devices:
        yield _model(device)
        yield _driver(device, broken)
    in_use = {device.driver for device in config.devices}
    for name in sorted(broken.keys() - in_use):
        yield warn(f"driver {name}", _unimportable(name, broken), REINSTALL)


def _unimportable(name: str, broken: dict[str, str]) -> str:
    return f"{name} cannot be imported: {broken[name]}."


def _import_error(entry: EntryPoint) -> str | None:
    try:
        entry.load()
    except Exception as error:  # a foreign package may raise anything at import; it is reported
        return f"{type(error).__name__}: {error}"
    return None


def _model(device: DeviceConfig) -> Finding:
    from hapticd.model import load_model

    subject = f"model of {device.id}"
    try:
        model = load_model(device.model, device.model_overrides)
    except (OSError, ValueError) as error:
        return fail(subject, str(error), "Correct model or overrides of the device in the configuration.")
    return ok(subject, f"{model.name}, {model.dof} coordinates.")


def _driver(device: DeviceConfig, broken: dict[str, str]) -> Finding:
    subject = f"driver of {device.id}"
    if device.driver == TWIN_DRIVER:
        return ok(subject, "The twin, which is built in.")
    if device.driver in broken:
        return fail(subject, _unimportable(device.driver, broken), REINSTALL)
    names = sorted(entry.name for entry in entry_points(group=GROUP))
    if device.driver not in names:
        known = ", ".join([TWIN_DRIVER, *names])
        return fail(subject, f"No driver {device.driver} is installed.", f"Choose among {known}.")
    return ok(subject, device.driver)
