"""Documents that a route completes before they are checked: merge patches, walls named by their address."""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from hapticd_api.errors import refused_document

Model = TypeVar("Model", bound=BaseModel)


def checked(model: type[Model], document: Any) -> Model:
    """`document` as `model`. Raises `Problem` (invalid-document, unknown-field), which names the field."""
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise refused_document(error.errors(), document) from None


def merged(target: Any, patch: Any) -> Any:
    """`target` with a JSON merge patch: objects merge, null removes, all else replaces (RFC 7396).

    An object whose `type` changes is replaced whole: the members of another kind would not fit it.
    """
    if not isinstance(patch, dict):
        return patch
    result = dict(target) if isinstance(target, dict) and _of_one_type(target, patch) else {}
    for name, value in patch.items():
        if value is None:
            result.pop(name, None)
        else:
            result[name] = merged(result.get(name), value)
    return result


def _of_one_type(target: dict[str, Any], patch: dict[str, Any]) -> bool:
    return "type" not in patch or patch["type"] == target.get("type")
