"""Puts an emulated board on a pseudo-terminal."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hapticd._core import Plant
from hapticd.model import load_model
from hapticd_drivers.emulation import Emulation
from hapticd_drivers.hapticd_io.emulated_board import emulated_board, emulated_options
from hapticd_drivers.hapticd_io.emulator import emulator
from hapticd_drivers.hapticd_io.needs import Needs
from hapticd_drivers.line import LineFaults
from hapticd_drivers.pseudo_terminal import PseudoTerminal


def emulate(
    *, twin: str, rate_hz: int, pacing: str, faults: str, hand: str, link: Path | None, seed: int
) -> tuple[Emulation, dict[str, Any]]:
    """A board with the twin of a device on it, and a report: port, options, configuration snippet.

    Raises:
        OptionError, ValueError: one of the settings is not possible.
    """
    model = load_model(twin)
    needs = Needs.of(model.device_json)
    board = emulated_board(needs, rate_hz, model.name, seed)
    cable = LineFaults.parse(faults)
    device = emulator(Plant(model.device_json, model.twin_json, float(rate_hz), seed), needs, board)
    device.control({"hand": json.loads(hand)})
    terminal = PseudoTerminal(link)
    port = str(link.absolute()) if link else terminal.port
    options = emulated_options(needs, board, port) | {"pacing": pacing}
    report = {
        "port": port,
        "driver": "hapticd_io",
        "model": model.name,
        "rate_hz": rate_hz,
        "options": options,
    }
    return Emulation(device, terminal, cable, seed), report | {"config": _snippet(report)}


def _snippet(report: dict[str, Any]) -> str:
    """The configuration file's section. JSON's texts, numbers and lists are TOML's."""
    device = {
        "id": report["model"].split("-")[0],
        **{key: report[key] for key in ("model", "driver", "rate_hz")},
    }
    lines = ["[[devices]]", *(f"{key} = {json.dumps(value)}" for key, value in device.items())]
    lines += [
        "",
        "[devices.options]",
        *(f"{key} = {json.dumps(value)}" for key, value in report["options"].items()),
    ]
    return "\n".join(lines) + "\n"
