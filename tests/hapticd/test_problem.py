"""Problems: their documents, and how a refused document is explained."""

import json
import re

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from hapticd.problem import Problem, invalid_document, json_pointer
from hapticd.problem_types import PROBLEM_TYPES


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid")
    eta: float = Field(le=1.0)


class Outer(BaseModel):
    model_config = ConfigDict(extra="forbid")
    laws: list[Inner]


def refused(document: object) -> ValidationError:
    with pytest.raises(ValidationError) as caught:
        Outer.model_validate(document)
    return caught.value


def test_every_kind_explains_itself_in_sentences() -> None:
    for kind in PROBLEM_TYPES.values():
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", kind.slug)
        assert 400 <= kind.status <= 599
        assert not kind.title.endswith(".")
        for sentence in (kind.cause, kind.check, kind.fix):
            assert sentence.endswith("."), (kind.slug, sentence)


def test_document_links_to_its_kind_and_leaves_out_what_is_not_known() -> None:
    problem = Problem("wall-not-found", "phantom has no wall 'floor'.", device_id="phantom", allowed=["roof"])
    assert problem.document() == {
        "type": "/problems/wall-not-found",
        "title": "There is no such wall",
        "status": 404,
        "detail": "phantom has no wall 'floor'.",
        "hint": PROBLEM_TYPES["wall-not-found"].fix,
        "device_id": "phantom",
        "allowed": ["roof"],
        "retryable": False,
    }


def test_document_of_a_problem_with_everything_is_json() -> None:
    problem = Problem(
        "interlock-open",
        "No.",
        hint="Wait.",
        pointer="/desired",
        current_state="fault",
        allowed=(),
        retryable=True,
        interlocks=[{"id": "estop-latched"}],
        errors=[{"pointer": "/a"}],
    )
    document = json.loads(json.dumps(problem.document()))
    assert document["allowed"] == []
    assert document["interlocks"] == [{"id": "estop-latched"}]
    assert document["retryable"] is True


def test_unregistered_slug_is_a_programming_error() -> None:
    with pytest.raises(KeyError):
        Problem("no-such-kind", "Never.")


def test_pointer_escapes_what_would_split_it() -> None:
    assert json_pointer(["walls", 3, "a/b", "c~d"]) == "/walls/3/a~1b/c~0d"


def test_out_of_range_field_is_named_by_its_pointer() -> None:
    problem = invalid_document(refused({"laws": [{"eta": 0.5}, {"eta": 1.2}]}))
    assert (problem.slug, problem.status, problem.pointer) == ("invalid-document", 422, "/laws/1/eta")
    assert "less than or equal to 1" in problem.detail


def test_unknown_field_is_its_own_kind_and_named() -> None:
    problem = invalid_document(refused({"laws": [{"eta": 0.5, "etta": 1}]}), inside=("scene",))
    assert (problem.slug, problem.pointer) == ("unknown-field", "/scene/laws/0/etta")
    assert "'etta'" in problem.detail


def test_every_offending_field_is_listed() -> None:
    problem = invalid_document(refused({"laws": [{"eta": 1.2}], "extra": 1}))
    assert problem.errors is not None
    assert {entry["pointer"] for entry in problem.errors} == {"/laws/0/eta", "/extra"}
    assert "1 more in errors" in problem.detail
