"""Documents on the command line: ``spring stiffness_n_per_m=800 passivity=true``."""

from __future__ import annotations

import json
from typing import Any

import typer


class Spec(dict[str, Any]):
    """A type and its fields, named as in the API; what they mean is for the daemon to check."""

    @classmethod
    def parse(cls, text: str) -> Spec:
        """The document that ``text`` spells, type first. Raises ``typer.BadParameter``."""
        kind, *fields = text.split() or [""]
        if not kind or "=" in kind:
            raise typer.BadParameter(
                f"{text!r} must begin with its type, such as: spring stiffness_n_per_m=800"
            )
        return cls(type=kind, **cls.parse_fields(" ".join(fields)))

    @classmethod
    def parse_fields(cls, text: str) -> Spec:
        """The document that ``text`` spells, without a type. Raises ``typer.BadParameter``."""
        spec = cls()
        for field in text.split():
            name, equals, value = field.partition("=")
            if not name or not equals or not value:
                raise typer.BadParameter(f"{field!r} is no field; write it as name=value.")
            spec[name] = _value(value)
        return spec


def _value(text: str) -> Any:
    """A list where there are commas, else JSON, else a word."""
    if "," in text:
        return [_value(part) for part in text.split(",")]
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text
