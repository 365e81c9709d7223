"""Problems: what went wrong, in the form of RFC 9457, with a page for each kind.

A problem names its kind by a slug. The kind says why it happens in general and how to cure it;
the problem says what happened this time. Kinds live in :mod:`hapticd.problem_types`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from hapticd.problem_types import PROBLEM_TYPES, ProblemType


class Problem(Exception):
    """A refusal or a failure that a caller can act on.

    ``slug`` is a key of ``PROBLEM_TYPES``; ``detail`` says what happened this time. ``pointer`` is the JSON
    pointer (RFC 6901) of the offending field, ``allowed`` what would have been accepted instead,
    ``interlocks`` the open interlocks of a refused change of state, ``errors`` every offending field of a
    refused document.

    Raises ``KeyError`` when the slug is not registered.
    """

    def __init__(
        self,
        slug: str,
        detail: str,
        *,
        hint: str | None = None,
        pointer: str | None = None,
        device_id: str | None = None,
        current_state: str | None = None,
        allowed: Sequence[str] | None = None,
        retryable: bool | None = None,
        interlocks: Sequence[Mapping[str, Any]] | None = None,
        errors: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        super().__init__(detail)
        self.type: ProblemType = PROBLEM_TYPES[slug]
        self.detail = detail
        self.hint = hint if hint is not None else self.type.fix
        self.pointer = pointer
        self.device_id = device_id
        self.current_state = current_state
        self.allowed = None if allowed is None else list(allowed)
        self.retryable = self.type.retryable if retryable is None else retryable
        self.interlocks = None if interlocks is None else [dict(entry) for entry in interlocks]
        self.errors = None if errors is None else [dict(entry) for entry in errors]

    @property
    def slug(self) -> str:
        return self.type.slug

    @property
    def title(self) -> str:
        return self.type.title

    @property
    def status(self) -> int:
        return self.type.status

    def document(self) -> dict[str, Any]:
        """The ``application/problem+json`` document; members without a value are left out."""
        members = {
            "type": f"/problems/{self.slug}",
            "title": self.title,
            "status": self.status,
            "detail": self.detail,
            "hint": self.hint,
            "pointer": self.pointer,
            "device_id": self.device_id,
            "current_state": self.current_state,
            "allowed": self.allowed,
            "retryable": self.retryable,
            "interlocks": self.interlocks,
            "errors": self.errors,
        }
        return {name: value for name, value in members.items() if value is not None}


def json_pointer(path: Iterable[str | int]) -> str:
    """JSON pointer of a path of keys and indices (RFC 6901)."""
    return "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in path)


def invalid_document(
    error: ValidationError | Sequence[Mapping[str, Any]],
    *,
    inside: Sequence[str | int] = (),
    device_id: str | None = None,
) -> Problem:
    """The problem for a document that a model refused.

    It points at the first offending field and lists all of them in ``errors``.

    ``error`` is pydantic's error or its list of errors; ``inside`` is where the document lies in a larger
    one.
    """
    found = error.errors() if isinstance(error, ValidationError) else error
    errors = [
        {
            "pointer": json_pointer((*inside, *entry["loc"], *_tag(entry))),
            "message": _message(entry),
            "kind": str(entry["type"]),
        }
        for entry in found
    ]
    first = errors[0]
    more = f" ({len(errors) - 1} more in errors)" if len(errors) > 1 else ""
    slug = "unknown-field" if first["kind"] == "extra_forbidden" else "invalid-document"
    detail = f"{first['pointer'] or 'The document'}: {first['message']}{more}"
    return Problem(slug, detail, pointer=first["pointer"], device_id=device_id, errors=errors)


def _tag(entry: Mapping[str, Any]) -> tuple[str, ...]:
    """The field that says which of several kinds a document is, where that field is what is wrong."""
    wrong = entry["type"] in ("union_tag_invalid", "union_tag_not_found")
    return (entry["ctx"]["discriminator"].strip("'"),) if wrong else ()


def _message(entry: Mapping[str, Any]) -> str:
    if entry["type"] == "union_tag_invalid":
        return f"There is no {entry['ctx']['tag']!r} here; write one of {entry['ctx']['expected_tags']}."
    if entry["type"] == "extra_forbidden":
        return f"There is no field {str(entry['loc'][-1])!r} here."
    message = str(entry["msg"]).removeprefix("Value error, ")
    return message if message.endswith(".") else message + "."
