"""Libraries that only experiments need."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from types import ModuleType

from hapticd.problem import Problem


def check_library(name: str) -> None:
    """``Problem`` (library-missing) unless the library is there; does not import it, which takes its time."""
    if find_spec(name) is None:
        detail = f"The Python library {name} is missing, which figures and traces need."
        raise Problem("library-missing", detail)


def require(name: str) -> ModuleType:
    """The module of that name. ``Problem`` (library-missing) says what installs it."""
    check_library(name.partition(".")[0])
    return importlib.import_module(name)
