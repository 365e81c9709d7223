"""Finding drivers by name."""

from __future__ import annotations

import sys
from importlib.metadata import EntryPoint, EntryPoints
from types import ModuleType

import pytest

from hapticd_drivers import registry
from hapticd_drivers.error import OptionError


def bring(monkeypatch: pytest.MonkeyPatch, **targets: str) -> None:
    """Another package brings drivers."""
    points = EntryPoints(EntryPoint(name, target, registry.GROUP) for name, target in targets.items())
    monkeypatch.setattr(registry, "entry_points", lambda **query: points.select(**query))


def test_the_drivers_of_this_package_are_there_without_any_entry_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bring(monkeypatch)
    assert registry.driver_names() == ["hapticd_io"]
    assert callable(registry.driver_module("hapticd_io").create)


def test_another_package_adds_its_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    bring(monkeypatch, falcon="falcon_driver")
    monkeypatch.setitem(sys.modules, "falcon_driver", ModuleType("falcon_driver"))
    assert registry.driver_names() == ["falcon", "hapticd_io"]
    assert registry.driver_module("falcon").__name__ == "falcon_driver"


def test_a_broken_driver_of_another_package_leaves_the_rest_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    bring(monkeypatch, broken="no_such_module_anywhere")
    assert registry.driver_names() == ["broken", "hapticd_io"]
    with pytest.raises(OptionError, match="driver broken cannot be imported"):
        registry.driver_module("broken")
    assert callable(registry.emulator("hapticd_io"))


def test_a_driver_without_an_emulator_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    bring(monkeypatch, falcon="falcon_driver")
    monkeypatch.setitem(sys.modules, "falcon_driver", ModuleType("falcon_driver"))
    with pytest.raises(OptionError, match="driver falcon has no emulator"):
        registry.emulator("falcon")


def test_an_unknown_driver_is_told_with_the_known_ones() -> None:
    with pytest.raises(OptionError, match=r"no driver haptic_io: choose from .*hapticd_io"):
        registry.driver_module("haptic_io")
