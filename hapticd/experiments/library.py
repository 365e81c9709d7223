"""Libraries that only experiments need."""

from __future__ import annotations

import importlib
from types import ModuleType

from hapticd.problem import Problem


def require(name: str) -> ModuleType:
    """The module of that name. ``Problem`` (library-missing) says what installs it."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        library = name.partition(".")[0]
        if error.name is None or error.name.partition(".")[0] != library:
            raise  # it is there and lacks something itself
        detail = f"The Python library {library} is missing, which figures and traces need."
        raise Problem("library-missing", detail) from None
