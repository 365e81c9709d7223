"""Which drivers there are: the ones of this package and those that other packages bring."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any, Final, cast

from hapticd_drivers.error import OptionError

GROUP: Final = "hapticd.drivers"

BUILT_IN: Final = {"hapticd_io": "hapticd_drivers.hapticd_io"}
"""Name and module; importing this table imports none of them."""


def driver_names() -> list[str]:
    """Names of all drivers, in alphabetical order."""
    return sorted({*BUILT_IN, *entry_points(group=GROUP).names})


def driver_module(name: str) -> ModuleType:
    """The module of one driver, with `create` and, where there is an emulator, `emulate`.

    Raises:
        OptionError: there is no such driver, or it cannot be imported.
    """
    target = BUILT_IN.get(name) or next((point.value for point in entry_points(group=GROUP, name=name)), None)
    if target is None:
        raise OptionError(f"no driver {name}: choose from {', '.join(driver_names())}")
    try:
        return import_module(target)
    except ImportError as error:
        raise OptionError(f"driver {name} cannot be imported: {error}") from error


def emulator(name: str) -> Callable[..., Any]:
    """The `emulate` of a driver's module: builds an `Emulation` and its report.

    Raises:
        OptionError: no such driver, or it has no emulator.
    """
    build = getattr(driver_module(name), "emulate", None)
    if build is None:
        raise OptionError(f"driver {name} has no emulator")
    return cast(Callable[..., Any], build)
