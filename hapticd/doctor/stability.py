"""How stiff a wall each device can render at its configured rate."""

from __future__ import annotations

from collections.abc import Iterator

from hapticd.analysis.device_loop import DeviceLoop, device_loop
from hapticd.analysis.measured_delay import command_delay_ticks, loop_delay_s
from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.analysis.settling_table import delay_ticks
from hapticd.analysis.stability import passive_limits
from hapticd.config import Config, DeviceConfig
from hapticd.doctor.finding import Finding, ok, warn
from hapticd.model import Model, load_model


def examine(config: Config) -> Iterator[Finding]:
    """One finding a device. What the twin bears is read from the daemon's tables, else simulated: seconds."""
    library = SettlingLibrary(config.paths.state_dir / "stability", keep=False)
    for device in config.devices:
        try:
            model = load_model(device.model, device.model_overrides)
        except (OSError, ValueError):
            continue  # told as the model's own finding
        yield _finding(device, model, library)


def _finding(device: DeviceConfig, model: Model, library: SettlingLibrary) -> Finding:
    subject = f"stability of {device.id}"
    loop = device_loop(model, device.rate_hz, loop_delay_s(device.rate_hz, 0.0, command_delay_ticks(model)))
    rigid = loop.coupling.stiffness_n_per_m
    passive = min(passive_limits(loop, 0.0).values())
    settled = _simulated(model, loop, library)
    said = (
        f"At {device.rate_hz:g} Hz walls are passive up to {_n_per_mm(passive)};"
        f" a rigid one has {_n_per_mm(rigid)}"
    )
    if settled is None:
        return warn(subject, f"{said}. It was not simulated.", "Add a [twin] to the model to know more.")
    detail = f"{said}, and the twin came to rest up to {_n_per_mm(settled)}."
    if settled >= rigid:
        return ok(subject, detail)
    return warn(subject, detail, "Raise rate_hz, or soften the drive in the model; see docs/stability.md.")


def _simulated(model: Model, loop: DeviceLoop, library: SettlingLibrary) -> float | None:
    table = library.table(model, loop.rate_hz, delay_ticks(loop.rate_hz, loop.delay_s))
    return table.largest_stiffness_n_per_m(loop.coupling.damping_n_s_per_m) if table else None


def _n_per_mm(stiffness_n_per_m: float) -> str:
    return f"{stiffness_n_per_m * 1e-3:.3g} N/mm"
