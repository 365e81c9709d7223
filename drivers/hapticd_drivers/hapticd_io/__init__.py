"""Boards that speak the hapticd I/O frame (docs/io-frame.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hapticd_drivers.hapticd_io.driver import HapticdIo, create

if TYPE_CHECKING:
    from hapticd_drivers.emulation import Emulation

__all__ = ["HapticdIo", "create", "emulate"]


def emulate(**settings: Any) -> tuple[Emulation, dict[str, Any]]:
    """See `emulated_port.emulate`. Imported late: the servo process needs none of it."""
    from hapticd_drivers.hapticd_io.emulated_port import emulate as build

    return build(**settings)
